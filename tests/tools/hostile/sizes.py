"""Few bytes that promise much: E-MEMORY or a message with a place, before anything is asked of the machine."""
from catalogue import case, scene, write


def block(kind, nx, ny):
    return scene(mesh=f"*BLOCK, TYPE={kind}, ELSET=B, NX={nx}, NY={ny}\n0, 9\n1, 9\n1, 10\n0, 10\n")


@case(2, "a block of more than 50000000 nodes")
def a_block_of_1e10_elements(folder):
    write(folder, block("CPE4", 100_000, 100_000))


@case(2, "a block of more than 50000000 nodes")
def a_block_whose_count_leaves_the_integers(folder):
    write(folder, block("CPE9", 2_147_483_647, 1))


@case(2)
def a_count_that_is_no_integer(folder):
    write(folder, block("CPE4", 10**30, 1))


@case(2)
def counts_below_one(folder):
    write(folder, block("CPE4", -2_147_483_648, 0))


@case(2, "[E-MEMORY]", mebibytes=400)
def a_mesh_that_does_not_fit(folder):
    write(folder, block("CPE4", 7000, 7000))


@case(2)
def nodes_generated_without_end(folder):
    write(folder, "*NODE\n1, 0, 0\n2000000000, 1, 0\n*NGEN\n1, 2000000000\n" + scene())


@case(2)
def elements_generated_without_end(folder):
    write(folder, scene(mesh="*ELGEN, ELSET=LOW\n1, 2000000000, 0, 1\n"))


@case(2)
def a_set_generated_without_end(folder):
    write(folder, scene(mesh="*NSET, NSET=ALL, GENERATE\n1, 2147483647, 1\n"))


@case(2)
def numbers_of_nodes_beyond_integers(folder):
    write(folder, "*NODE\n9223372036854775808, 0, 0\n2147483648, 1, 1\n-1, 0, 1\n" + scene())


@case(3, "more than INC=100 increments")
def increments_without_end(folder):
    write(folder, scene().replace("*STATIC\n", "*STATIC\n1e-300, 1e300, 1e-300, 1e-300\n"))
    return ["deck.inp", "--quiet"]


@case(1, "--refine 2000000000 is not possible")
def refinement_without_end(folder):
    write(folder, scene())
    return ["check", "deck.inp", "--refine", "2000000000"]


@case(2, seconds=4)
def an_equation_of_as_many_terms_as_integers(folder):
    write(folder, scene(model="*EQUATION\n2147483647\n7, 1, 1.\n"))
