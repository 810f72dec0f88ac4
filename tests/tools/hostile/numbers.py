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


@case(SOLVED_OR_TOLD)
def a_modulus_near_the_largest_number(folder):
    write(folder, scene(young="1e308"))
    return SOLVE


@case(SOLVED_OR_TOLD)
def a_modulus_near_the_least_number(folder):
    write(folder, scene(young="1e-307"))
    return SOLVE


@case(SOLVED_OR_TOLD)
def a_load_near_the_largest_number(folder):
    write(folder, scene(q="1e300"))
    return SOLVE + ["--contact", "dense"]


@case(SOLVED_OR_TOLD)
def a_load_near_the_largest_number_in_the_sparse_form(folder):
    write(folder, scene(q="1e300"))
    return SOLVE + ["--contact", "sparse"]


@case(SOLVED_OR_TOLD)
def coordinates_whose_squares_are_nothing(folder):
    write(folder, scene(size="1e-162"))
    return SOLVE


@case(SOLVED_OR_TOLD)
def coordinates_whose_squares_are_too_large(folder):
    write(folder, scene(size="1e160"))
    return SOLVE


@case(SOLVED_OR_TOLD)
def coordinates_whose_differences_are_lost(folder):
    write(folder, scene().replace("0, 0\n1, 0\n1, 1\n0, 1\n", "1e17, 0\n<1e17+1>, 0\n<1e17+1>, 1\n1e17, 1\n"))
    return SOLVE
