"""Many of a kind that a deck may have: ten thousand or more, for which nothing may take the square of their number."""
from catalogue import case, scene, write

N = 10_000


@case(says="no errors", seconds=4)
def node_sets(folder):
    write(folder, scene(mesh="".join(f"*NSET, NSET=N{k}\n{1 + k % 9}\n" for k in range(N))))


@case(says="no errors", seconds=4)
def sets_of_sets(folder):
    write(folder, scene(mesh="*NSET, NSET=N0\n1\n" + "".join(f"*NSET, NSET=N{k}\nN{k - 1}\n" for k in range(1, N))))


@case(says="no errors", seconds=4)
def amplitudes(folder):
    write(folder, scene(model="".join(f"*AMPLITUDE, NAME=A{k}\n0, 0, 1, 1\n" for k in range(N))))


@case(says="no errors", seconds=4)
def lines_of_boundary(folder):
    write(folder, scene(model="*BOUNDARY\n" + "LOW-BOTTOM, 1, 2\n" * N))


@case(says="no errors", seconds=4)
def terms_of_an_equation(folder):
    terms = "".join(f"{1 + k % 3 + 6}, {1 + k % 2}, 1.\n" for k in range(N))
    write(folder, scene(model=f"*EQUATION\n{N}\n{terms}"), "deck.inp")


@case(2, "[E-", seconds=4)
def refused_cards(folder):
    write(folder, scene(model="*SHELL SECTION, ELSET=LOW\n1\n" * N))


@case((0, 2), seconds=4)
def cards_that_are_unknown(folder):
    write(folder, scene(model="".join(f"*WORD{k}\n1\n" for k in range(N))))


@case(2, "[E-", seconds=4)
def names_that_are_none(folder):
    write(folder, scene(model="*BOUNDARY\n" + "".join(f"NO-SUCH-{k}, 1, 2\n" for k in range(N))))


@case(2, "[E-", seconds=4)
def nodes_twice(folder):
    write(folder, "*NODE\n" + "1, 0, 0\n" * N + scene())


@case(says="no errors", seconds=6)
def nodes_line_by_line(folder):
    nodes = "".join(f"{1000 + k}, {10 + k}, 0\n" for k in range(20 * N))
    write(folder, scene(mesh="*NODE\n" + nodes))


@case(says="no errors", seconds=4)
def steps(folder):
    write(folder, scene(last="*STEP\n*STATIC\n*END STEP\n" * 500))


@case(2, "[E-", seconds=4)
def includes_of_a_file_by_itself(folder):
    write(folder, "*INCLUDE, INPUT=deck.inp\n" * N)


@case(says="no errors", seconds=4)
def a_sum_as_parameter(folder):
    write(folder, "*PARAMETER\na = " + "+".join(["1"] * N) + "\n" + scene())


@case(says="no errors", seconds=4)
def parameters_of_parameters(folder):
    write(folder, "*PARAMETER\na0 = 1\n" + "".join(f"a{k} = a{k - 1} + 1\n" for k in range(1, 3000)) + scene())
