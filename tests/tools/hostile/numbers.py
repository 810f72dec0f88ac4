"""Numbers at the ends of what a machine knows: solved, or refused in words that name the cause."""
from catalogue import case, scene, write

SOLVE = ["deck.inp", "--quiet", "-o", "out"]
SOLVED_OR_TOLD = (0, 2, 3, 4)


@case(2)
def a_modulus_beyond_the_largest_number(folder):
    write(folder, scene(young="1e400"))


@case(2)
def words_for_numbers(folder):
    write(folder, scene(young="NaN", q="Infinity"))


@case(2)
def a_quotient_by_zero(folder):
    write(folder, scene(young="<1/0>"))


RANGE = "numbers leave the range of the machine"


def in_both_forms(code, says, **scene_of):
    """A case for each form of the contact system."""
    for form in ["dense", "sparse"]:
        def make(folder, form=form):
            write(folder, scene(**scene_of))
            return SOLVE + ["--contact", form]
        make.__name__ = "_".join(f"{name} {value.split()[-1]}" for name, value in scene_of.items()) + ", " + form
        case(code, says)(make)


in_both_forms((3, 4), RANGE, young="1.7e308")
in_both_forms((3, 4), RANGE, young="1e-310")
in_both_forms((3, 4), RANGE, q="1e300", size="1e50")
in_both_forms((3, 4), RANGE, q="1e200", young="1e-200")
in_both_forms((3, 4), RANGE, q="1", step="*BOUNDARY\nHIGH-TOP, 2, 2, -1e308\n")
in_both_forms(0, (), young="1e300")
in_both_forms(0, (), young="1e-300")
in_both_forms(0, (), q="1e300")
in_both_forms(0, (), q="1e-200")
in_both_forms(0, (), size="1e-148")
for length in ["1e-155", "1e-162", "1e-300"]:
    in_both_forms(2, "so small that its area is no number of the machine", size=length)


@case()
def a_load_near_the_largest_number_that_makes_points_slip(folder):
    slips = scene(q="1e300", n=6).replace("*FRICTION\n0.3", "*FRICTION\n0.05").replace("HIGH-TOP, 1, 1\n", "HIGH-RIGHT, 1, 1\n")
    write(folder, slips)
    return SOLVE + ["--contact", "sparse"]


@case((3, 4), RANGE)
def a_load_near_the_largest_number_on_sides_that_do_not_match(folder):
    wide = scene(young="1e5", size="2", q="1e308", n=1, step="*CLOAD\nHIGH-TOP, 1, 1e306\n")
    wide = wide.replace("0, 0\n2, 0\n2, 2\n0, 2\n", "-1, 0\n3, 0\n3, 2\n-1, 2\n")
    write(folder, wide.replace("HIGH-TOP, 1, 1\n", ""))
    return SOLVE


@case(4, "is free to move")
def a_motion_that_is_free(folder):
    write(folder, scene(q="-1"))
    return SOLVE


@case(SOLVED_OR_TOLD)
def coordinates_whose_squares_are_too_large(folder):
    write(folder, scene(size="1e160"))
    return SOLVE


@case(SOLVED_OR_TOLD)
def coordinates_whose_differences_are_lost(folder):
    write(folder, scene().replace("0, 0\n1, 0\n1, 1\n0, 1\n", "1e17, 0\n<1e17+1>, 0\n<1e17+1>, 1\n1e17, 1\n"))
    return SOLVE
