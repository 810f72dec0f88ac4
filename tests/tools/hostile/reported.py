"""What was found from outside: devices as includes, small decks that took minutes or gigabytes."""
from catalogue import case, scene, write


@case(5)
def an_include_of_zeros_without_end(folder):
    write(folder, "*INCLUDE, INPUT=/dev/zero\n" + scene())


@case(5)
def an_include_of_random_bytes_without_end(folder):
    write(folder, "*INCLUDE, INPUT=/dev/urandom\n" + scene())


@case(5)
def an_include_of_standard_input(folder):
    write(folder, "*INCLUDE, INPUT=/dev/stdin\n" + scene())


@case(says="no errors", seconds=2)
def a_heading_of_a_megabyte(folder):
    write(folder, scene().replace("hostile\n", "x" * 1_000_000 + "\n"))


@case(says="no errors", seconds=2)
def ten_thousand_empty_steps(folder):
    write(folder, scene(last="*STEP\n*STATIC\n*END STEP\n" * 10_000))


@case(says="no errors", seconds=2)
def thirty_thousand_parameters(folder):
    write(folder, "*PARAMETER\na0 = 1\n" + "".join(f"a{k} = a{k - 1} + 1\n" for k in range(1, 30_000)) + scene())


@case(says="no errors", seconds=2)
def a_sum_of_three_hundred_thousand_terms(folder):
    write(folder, "*PARAMETER\na = " + "+".join(["1"] * 300_000) + "\n" + scene())


@case((0, 2), seconds=2)
def a_hundred_thousand_unknown_keywords(folder):
    write(folder, scene(model="".join(f"*WORD{k}\n1\n" for k in range(100_000))))


@case(seconds=8)  # most of it gnuplot's
def a_hundred_thousand_lines_of_heading_in_a_report(folder):
    write(folder, "*HEADING\n" + "a line of the heading\n" * 100_000 + scene().replace("*HEADING\nhostile\n", ""))
    return ["deck.inp", "--quiet", "--report", "-o", "out"]


BIG = "*BLOCK, ELSET=BIG, TYPE=CPE4, NX=1000, NY=1000\n9, 9\n10, 9\n10, 10\n9, 10\n"


@case((0, 2), seconds=10, mebibytes=1000)
def sets_that_name_a_large_block(folder):
    write(folder, scene(mesh=BIG + "".join(f"*ELSET, ELSET=E{k}\nBIG\n" for k in range(1000))))


@case((0, 2), seconds=10, mebibytes=1000)
def a_set_that_names_a_large_block_again_and_again(folder):
    write(folder, scene(mesh=BIG + "*ELSET, ELSET=E\n" + "BIG\n" * 5000))


@case((0, 2), seconds=10, mebibytes=1000)
def surfaces_of_a_large_block(folder):
    write(folder, scene(mesh=BIG + "".join(f"*SURFACE, NAME=S{k}, TYPE=ELEMENT\nBIG, S1\n" for k in range(3000))))


@case((0, 2), seconds=4, mebibytes=400)
def groups_of_one_entity(folder):
    n = 1_000_000
    write(folder, "*INCLUDE, INPUT=m.msh\n" + scene())
    write(folder, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 0 0 1 1 0 " + f"{n} "
          + " ".join(str(k) for k in range(1, n + 1)) + " 0\n$EndEntities\n$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 5 0\n1 5 0\n"
          "0 6 0\n$EndNodes\n$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n", "m.msh")


@case((0, 2), seconds=4, mebibytes=400)
def fifty_megabytes_of_blank_lines(folder):
    write(folder, scene(mesh="\n" * 50_000_000))
