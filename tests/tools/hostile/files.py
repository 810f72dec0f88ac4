"""Other files that a deck names: what is no file, circles, links, meshes and tables that are none."""
import os

from catalogue import case, scene, write

MSH = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"


def include(folder, name, text=None):
    if text is not None:
        write(folder, text, name)
    write(folder, f"*INCLUDE, INPUT={name}\n" + scene())


@case((2, 5))
def an_include_that_is_a_folder(folder):
    os.mkdir(os.path.join(folder, "part.inp"))
    include(folder, "part.inp")


@case((2, 5))
def an_include_that_is_a_pipe(folder):
    os.mkfifo(os.path.join(folder, "part.inp"))
    include(folder, "part.inp")


@case((2, 5))
def an_include_of_the_memory_of_the_program(folder):
    include(folder, "/proc/self/mem")


@case((2, 5))
def a_link_to_itself(folder):
    os.symlink("part.inp", os.path.join(folder, "part.inp"))
    include(folder, "part.inp")


@case(2, "in a circle")
def a_circle_of_includes(folder):
    write(folder, "*INCLUDE, INPUT=deck.inp\n", "part.inp")
    include(folder, "part.inp")


@case(2, "includes of more than 10000 files", seconds=4)
def includes_that_double(folder):
    for k in range(16):
        write(folder, f"*INCLUDE, INPUT=d{k + 1}\n" * 2, f"d{k}")
    write(folder, "", "d16")
    include(folder, "d0")


@case(2)
def a_mesh_without_its_end(folder):
    include(folder, "m.msh", MSH + "$Nodes\n1 100000000 1 100000000\n2 1 0 100000000\n")


@case(2)
def a_mesh_of_counts_that_are_none(folder):
    include(folder, "m.msh", MSH + "$Entities\n-1 99999999999999999999 1e9 x\n$EndEntities\n$Nodes\n-5 -5 -5 -5\n$EndNodes\n")


@case(2)
def a_mesh_of_numbers_far_apart(folder):
    include(folder, "m.msh", MSH + "$Nodes\n1 3 1 2147483647\n2 1 0 3\n1\n2147483647\n1073741824\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
            "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2147483647 1073741824\n$EndElements\n")


@case(2)
def a_binary_mesh(folder):
    include(folder, "m.msh", b"$MeshFormat\n4.1 1 8\n\x01\x00\x00\x00\n$EndMeshFormat\n" + bytes(range(256)) * 500)


@case((2, 5))
def a_restart_file_that_is_text(folder):
    write(folder, scene())
    write(folder, scene(), "r.h5")
    return ["deck.inp", "--restart", "r.h5"]


@case((2, 5))
def a_restart_file_of_a_head_alone(folder):
    write(folder, scene())
    write(folder, b"\x89HDF\r\n\x1a\n" + b"\xff" * 4096, "r.h5")
    return ["deck.inp", "--restart", "r.h5"]


@case((1, 2, 5))
def tables_that_are_none(folder):
    write(folder, b"# of nothing\n# a b c\n1 2\nx y z\n\xff\xfe\n" * 3000, "a.tab")
    write(folder, bytes(100_000), "b.tab")
    return ["compare", "a.tab", "b.tab"]


@case(5, "has more than 10000 columns")
def a_table_of_a_hundred_thousand_columns(folder):
    write(folder, "# columns: " + " ".join(f"c{k}" for k in range(100_000)) + "\n", "a.tab")
    return ["compare", "a.tab", "a.tab"]


@case(5, "values for 9000 columns")
def a_table_of_many_columns_and_short_rows(folder):
    write(folder, "# columns: " + " ".join(f"c{k}" for k in range(9000)) + "\n" + "1\n" * 200_000, "a.tab")
    return ["compare", "a.tab", "a.tab"]


@case(5, "has more than 10000 columns")
def comma_separated_values_of_a_hundred_thousand_columns(folder):
    write(folder, ",".join(f"c{k}" for k in range(100_000)) + "\n", "a.csv")
    return ["compare", "a.csv", "a.csv"]


@case(5, "line 3 has control characters")
def a_table_that_tells_the_terminal_something(folder):
    write(folder, "# columns: a b\n1 2\nx\x1b]0;y\x07 1\n", "a.tab")
    write(folder, "# columns: a b\n1 2\nx 1\n", "b.tab")
    return ["compare", "b.tab", "a.tab"]
