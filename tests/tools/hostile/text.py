"""Text that is no deck, or a strange one: long lines and names, bytes of all kinds, depth."""
import random

from catalogue import case, scene, write


@case(2, "E-EMPTY")
def nothing(folder):
    write(folder, "")


@case(2, "E-EMPTY")
def comments_alone(folder):
    write(folder, "** nothing\n" * 20000)


@case(2, "E-BINARY")
def zeros(folder):
    write(folder, bytes(1_000_000))


@case(2)
def random_bytes(folder):
    write(folder, random.Random(1).randbytes(300_000))


@case(2, seconds=5)
def random_lines_of_printable_bytes(folder):
    draw = random.Random(2)
    write(folder, "".join(draw.choice("*,=<>()+-eE0123456789. \nabcNODESTP") for _ in range(300_000)))


@case(2)
def bytes_of_no_utf_8(folder):
    write(folder, scene().encode() + b"*ELSET, ELSET=\xff\xfe\x80\xc3\n\xc0\xaf\xed\xa0\x80\n" * 500)


@case(2)
def control_characters_in_names(folder):
    write(folder, scene(model="".join(f"*NSET, NSET=A{chr(k)}[31mB\nX{chr(k)}Y\n" for k in (1, 7, 8, 27, 127, 133, 155)) * 20))


@case(2)
def one_line_without_an_end(folder):
    write(folder, scene() + "*NODE " + "x" * 1_000_000)


@case(2)
def a_line_of_commas(folder):
    write(folder, "*NODE\n" + "," * 300_000 + "\n" + scene())


@case(2)
def a_name_of_a_hundred_thousand_characters(folder):
    write(folder, scene(model="*NSET, NSET=" + "N" * 100_000 + "\n1\n*BOUNDARY\n" + "N" * 99_999 + ", 1, 2\n"))


@case(2)
def options_by_the_thousand(folder):
    write(folder, "*NODE" + "".join(f", WORD{k}=1" for k in range(10_000)) + "\n" + scene())


@case(2)
def brackets_in_an_expression(folder):
    write(folder, "*PARAMETER\na = " + "(" * 50_000 + "1" + ")" * 50_000 + "\n" + scene())


@case(2)
def signs_in_an_expression(folder):
    write(folder, "*PARAMETER\na = " + "-" * 100_000 + "1\n" + scene())


@case(2)
def powers_of_powers(folder):
    write(folder, "*PARAMETER\na = " + "9**" * 50_000 + "9\n" + scene())


@case((0, 2))
def carriage_returns_alone(folder):
    write(folder, scene().replace("\n", "\r"))


@case()
def line_ends_of_windows_and_a_mark_of_byte_order(folder):
    write(folder, b"\xef\xbb\xbf" + scene().replace("\n", "\r\n").encode())


@case()
def blanks_by_the_megabyte(folder):
    write(folder, scene(mesh=" " * 1_000_000 + "\n"))


@case(says="no errors", seconds=4)
def a_heading_of_ten_thousand_lines(folder):
    write(folder, "*HEADING\n" + "a line of the heading\n" * 10_000 + scene().replace("*HEADING\nhostile\n", ""))
