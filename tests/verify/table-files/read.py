"""Reads the tables of a run in both forms: Python's csv, numpy and pandas where they are there. Arguments: the folders TAB CSV."""
import csv
import sys

tab, comma = sys.argv[1], sys.argv[2]


def with_head(path):
    """Names and rows of a table with a head."""
    with open(path, encoding="utf-8") as file:
        lines = file.read().splitlines()
    names = next(line.split()[2:] for line in lines if line.startswith("# columns:"))
    return names, [line.split() for line in lines if not line.startswith("#")]


for table in ("contact", "summary", "history", "iterations"):
    names, rows = with_head(f"{tab}/{table}.tab")
    with open(f"{comma}/{table}.csv", newline="", encoding="utf-8") as file:
        found = list(csv.reader(file, strict=True))
    assert found[0] == names, table
    assert [[item.lower() for item in row] for row in found[1:]] == rows, table
print("csv: same")

try:
    import numpy
except ImportError:
    print("numpy: not here")
else:
    a = numpy.loadtxt(f"{tab}/contact.tab")
    b = numpy.loadtxt(f"{comma}/contact.csv", delimiter=",", skiprows=1)
    assert a.shape == b.shape and (a == b).all()
    named = numpy.genfromtxt(f"{comma}/contact.csv", delimiter=",", names=True)
    assert (named["pressure"] == a[:, 7]).all()
    print("numpy: same")

try:
    import pandas
except ImportError:
    print("pandas: not here")
else:
    frame = pandas.read_csv(f"{comma}/contact.csv")
    names, rows = with_head(f"{tab}/contact.tab")
    assert list(frame.columns) == names
    assert [float(row[7]) for row in rows] == list(frame["pressure"])
    assert frame["status"].dtype.kind == "i"
    history = pandas.read_csv(f"{comma}/history.csv")
    assert history["centre"].dtype.kind == "f"
    spaced = pandas.read_csv(f"{tab}/contact.tab", sep=r"\s+", comment="#", names=names)
    assert (spaced == frame).all().all()
    print("pandas: same")
