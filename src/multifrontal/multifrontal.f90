!> The sparse solver: what the rest of the program sees of it. docs/developer/multifrontal.md tells how it works.
!>
!> - order_elements finds an order of elimination, and add_to_store collects the matrices of the elements.
!> - plan_fronts finds the fronts of both, expect_factors what they will take, factor_fronts factors them; forward and backward
!>   solve, one load at a time.
!> - The same for a matrix of which some elements change: create_variable_matrix and what goes with it.
module atrito_multifrontal
   use atrito_dissection, only: dissection_t
   use atrito_element_order, only: order_elements
   use atrito_element_store, only: element_store_t, begin_store, add_to_store, move_store, take_own_matrices, &
                                   sum_couplings, sum_diagonals, pack_matrix, unpack_matrix
   use atrito_elimination, only: elimination_t, chain_elimination
   use atrito_front_factors, only: fronts_t, front_bytes_t, plan_fronts, expect_factors, factor_fronts, held_bytes, &
                                   smallest_ratio, tell_of_memory
   use atrito_front_solves, only: forward, backward
   use atrito_metis, only: has_metis, metis_version, metis_trouble
   use atrito_variable_matrix, only: variable_matrix_t, create_variable_matrix, set_variable_element, factor_variable_matrix, &
                                     solve_variable_matrix, solve_at_variable, take_signs, kept_values, reduce_variable, &
                                     expand_variable, add_fixed_product, fixed_diagonal, expect_variable_factors, &
                                     variable_matrix_bytes
   implicit none (type, external)
   public

end module atrito_multifrontal
