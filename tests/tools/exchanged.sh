#!/bin/sh
# No component of a type can be forgotten that a restart file should have: what the procedures that write, read and compare it name is
# held against the types. A component is named by `variable%component`, or stands in the rule as one that need not be.
#    exchanged.sh SRC
. "$(dirname "$0")/lib.sh"
src=$1
here=$(cd "$(dirname "$0")" && pwd)

# type, file, procedures (* all), variable, components that are left out
cat >"$work/rules" <<'RULES'
frame_numbers_t    fields/exchange_results.f90 exchange_results results
results_t          fields/exchange_results.f90 exchange_results results frame_numbers_t
contact_result_t   fields/exchange_results.f90 exchange_contact contact
unsettled_t        fields/exchange_results.f90 exchange_unsettled point
body_motion_t      fields/exchange_results.f90 exchange_motion body
rigid_result_t     fields/exchange_results.f90 exchange_rigid body
joint_t            fields/exchange_results.f90 exchange_joint joint
observed_t         fields/exchange_results.f90 exchange_observed list
quantity_bound_t   fields/exchange_results.f90 exchange_bounded bound
observed_list_t    fields/restart_file.f90 exchange_observed_list list
cut_force_t        fields/exchange_results.f90 exchange_cut cut
iteration_t        fields/exchange_results.f90 exchange_iterations list
uniqueness_t       fields/exchange_results.f90 exchange_uniqueness uniqueness
error_bound_t      fields/exchange_results.f90 exchange_bound bound
extreme_t          fields/exchange_results.f90 exchange_extreme extreme
balance_t          fields/exchange_results.f90 exchange_balance balance
scene_t            fields/exchange_results.f90 exchange_scene scene
body_result_t      fields/exchange_results.f90 exchange_bodies body
pair_scene_t       fields/exchange_results.f90 exchange_pairs pair
string_t           fields/exchange_results.f90 exchange_left_out list
history_t          fields/restart_file.f90 exchange_findings history others,ending,factorisations,store,n_stored
history_row_t      fields/restart_file.f90 exchange_rows list
restart_state_t    fields/restart_file.f90 exchange_state,exchange_findings state
warm_start_t       fields/restart_file.f90 exchange_start start
box_state_t        fields/restart_file.f90 exchange_start state
box_bounds_t       fields/restart_file.f90 exchange_start bounds
multiplier_t       fields/restart_file.f90 exchange_multipliers multipliers factorisations,solves,generation,part,before
warm_start_t       stepping/warm_start.f90 put_start start
warm_start_t       stepping/warm_start.f90 take_start start
contact_solution_t stepping/warm_start.f90 put_start solution factor,inner,converged,verdict,factorisations,body_motion,body_force,flexibility,round_off,has_settled
slip_memory_t      fields/restart_file.f90 exchange_state memory is_incremental
run_t              analysis/history_run.f90 record run options,reporter,scene,has_last,observer,sense,idle,n_idle
run_t              analysis/history_run.f90 resume run reporter,observer,idle,n_idle
progress_t         analysis/history_run.f90 record now cuts
model_t            model/fingerprint.f90 * model deck_path,deck_name,heading,units,parameters,instances,levels,n_cut,node_sets,element_sets,springs,ties,equations,inclined,sources,restart_every,asks_nlgeom,solver_mesh,provenance,as_run,observed,has_arcs
mesh_t             model/fingerprint.f90 digest_of_mesh mesh node_map,element_map
material_t         model/fingerprint.f90 digest_of_materials material name
section_t          model/fingerprint.f90 digest_of_materials sections elset,is_tapered
surface_t          model/fingerprint.f90 digest_of_surfaces surface
face_list_t        model/fingerprint.f90 digest_of_surfaces faces
interaction_t      model/fingerprint.f90 digest_of_interactions law
pair_t             model/fingerprint.f90 digest_of_pairs pair adjust,adjust_set,is_resolved,is_exchanged
contact_points_t   model/fingerprint.f90 add_points points node,s,length,n_faces,n_left_out,n_seeing,faces,coarseness,coarse_node,piece,doubt,is_held,sliding
bilateral_rows_t   model/fingerprint.f90 digest_of_rows rows n_groups
step_t             model/fingerprint.f90 * step title,began
nodal_values_t     model/fingerprint.f90 add_nodal_values values source
element_load_t     model/fingerprint.f90 add_element_loads loads line,source
amplitude_t        model/fingerprint.f90 add_amplitudes amplitude name
increments_t       model/fingerprint.f90 add_way way
controls_t         model/fingerprint.f90 add_way controls is_rung,logs_solves,most_factorisations
requests_t         model/fingerprint.f90 add_requests requests
frequencies_t      model/types/model.f90 all_frequencies every
path_t             model/fingerprint.f90 add_paths path place,s,x,along
requested_t        model/fingerprint.f90 add_requested requested
RULES

judge() { # judge SRC: what is wrong, a line each
   (cd "$1" && find . -name '*.f90' | sed 's,^\./,,' | xargs awk -f "$here/exchanged.awk" "$work/rules")
}

judge "$src" >"$work/wrong"
while read -r line; do
   fail "$line"
done <"$work/wrong"

# and it finds what is forgotten: a new component, one that is no longer written, a type without a rule, a rule without a type
mkdir "$work/copy"
must_find() { # must_find FILE SED-COMMAND TEXT
   rm -rf "$work/copy"
   cp -r "$src" "$work/copy"
   sed "$2" "$src/$1" >"$work/copy/$1"
   cmp -s "$src/$1" "$work/copy/$1" && fail "$1: $2 changes nothing"
   judge "$work/copy" | grep -qF -- "$3" || fail "not found: $3"
}
must_find model/types/results.f90 's/^      logical :: law_holds = .*/&\n      real(wp), allocatable :: wear(:), worn(:)/' 'frame_numbers_t: worn'
must_find fields/exchange_results.f90 '/contact%slip_increment/d' 'contact_result_t: slip_increment'
must_find model/types/results.f90 's/^      type(scene_t) :: scene/&\n      type(ending_t) :: ending/' 'ending_t has no rule'
must_find analysis/history_run.f90 '/run%condition = state%condition/d' 'run_t: condition'
must_find model/types/model.f90 's/^   type :: pair_t$/   type :: couple_t/' 'there is no type pair_t'
finish
