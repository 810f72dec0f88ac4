"""Kinds of growth that tests/bench/growth.py measures, with numbers for which the square of them would take minutes."""
import os
import sys

from catalogue import case, write

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "bench"))
from growth_decks import KINDS  # noqa: E402

#        kind                        n        s   MiB
MANY = [("heading_long_line",        1000000, 2, 200),
        ("blank_lines",             10000000, 4, 200),
        ("parameters_in_chain",        30000, 2, 200),
        ("parameters_used",            30000, 4, 200),
        ("sum_of_names",              300000, 4, 200),
        ("node_cards_one_set",         50000, 6, 300),
        ("one_set_of_nodes_grown",     50000, 6, 300),
        ("ngen_lines",                100000, 4, 300),
        ("elcopy_cards",               30000, 6, 300),
        ("elset_names_a_block",        10000, 2, 200),
        ("elsets_of_a_block",          10000, 4, 200),
        ("elsets_that_generate_a_block", 10000, 4, 200),
        ("surfaces",                   30000, 4, 300),
        ("surfaces_of_a_block",         3000, 4, 300),
        ("clearance_cards",             5000, 6, 400),
        ("clearance_lines",            50000, 4, 200),
        ("equations",                   5000, 6, 400),
        ("springs",                     5000, 6, 400),
        ("rigid_bodies",                5000, 6, 300),
        ("instances",                   5000, 6, 300),
        ("blocks_merged",               3000, 6, 300),
        ("section_prints",             10000, 4, 200),
        ("gmsh_groups_of_one_entity", 100000, 4, 400),
        ("gmsh_entity_groups",         30000, 6, 400),
        ("bad_keywords",               50000, 6, 300),
        ("bad_names",                  50000, 6, 300),
        ("bad_parameters",             50000, 6, 300),
        ("bad_surfaces",               10000, 6, 300)]


def make_of(kind, n):
    def make(folder):
        for name, text in KINDS[kind][0](n).items():
            write(folder, text, name)
    make.__name__ = kind
    return make


for kind, n, seconds, mebibytes in MANY:
    case(2 if kind.startswith("bad_") else 0, seconds=seconds, mebibytes=mebibytes)(make_of(kind, n))
