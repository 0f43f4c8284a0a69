# SPDX-License-Identifier: GPL-3.0-or-later
"""One packing of 100 spheres as people and programs write it: a table of files, each either read, with the permeability
of the plain table, or refused, with the cause in the message. `test_file_variants.py` solves them all."""
import bz2
import dataclasses
import gzip
import io
import json
import lzma
import struct
import tarfile
import zipfile

from command import DENSE, THROUGH_FLOW, UNIT_BOX, dense_rows

HEADER, ROWS = dense_rows()
PLAIN = DENSE.read_text()
NUMBERS = [(int(row[0]), *map(float, row[1:])) for row in ROWS]
DIAMETERS = [(*row[:4], repr(2 * float(row[4]))) for row in ROWS]
SOLVE = [*UNIT_BOX, *THROUGH_FLOW]


@dataclasses.dataclass
class Variant:
    name: str
    content: bytes
    options: list = dataclasses.field(default_factory=lambda: SOLVE)
    refused: tuple = ()       # parts of the message; empty: the file is read
    plain: list = None        # options with which the plain table is solved, where they are others
    said: tuple = ()          # parts of the remarks of a file that is read
    factor: float = 1.0       # of the plain table's permeability; None: none is given
    tolerance: float = 1e-12  # relative, beside that
    extra: tuple = ()         # those options that the file needs


FILES = []  # groups of variants: (title, [Variant])


def group(title):
    FILES.append((title, []))


def read(name, content, *options, flow=SOLVE, **expected):
    """A file that is read; options: those that it needs, beside those of the flow."""
    content = content.encode() if isinstance(content, str) else content
    FILES[-1][1].append(Variant(name, content, [*flow, *options], extra=options, **expected))


def refused(name, content, *parts, options=()):
    read(name, content, *options, refused=parts)


def lines(rows, separator=",", header=HEADER, end="\n"):
    return "".join(separator.join(map(str, row)) + end for row in ([header] if header else []) + list(rows))


def changed(line, text, rows=PLAIN):
    """The plain table with another text in the place of a line, counted from 1."""
    parts = rows.splitlines(keepends=True)
    return "".join([*parts[:line - 1], text, *parts[line:]])


# --------------------------------------------------------------------------------------------- tables

group("Tables")
NO_END = ("the last line has no end; its last number may be cut off",)
read("plain table", PLAIN)
for separator, word in ((";", "semicolons"), ("\t", "tabs"), (" ", "blanks"), ("   ", "many blanks"),
    (" , ", "commas with blanks"),
                        (",\t", "commas with tabs")):
    read(f"separated by {word}", lines(ROWS, separator))
read("blanks before each line", "".join("   " + line + "\n" for line in lines(ROWS, "  ").splitlines()))
read("line ends of Windows", PLAIN.replace("\n", "\r\n"))
read("line ends of old Macs", PLAIN.replace("\n", "\r"))
read("no line end after the last line", PLAIN[:-1], said=NO_END)
read("no line end after a last comma", PLAIN.replace("\n", ",\n")[:-1])
read("no line end after a last quote", lines(
    [[f'"{field}"' for field in row] for row in [HEADER, *ROWS]], header=None)[:-1])
read("no line end after a last comment", PLAIN + "# 100")
read("cut off within the last number, 0.082 for 0.0824", PLAIN[:-16], tolerance=1e-3, said=NO_END)
read("empty lines between and behind", PLAIN.replace("\n", "\n\n") + "\n  \n")
read("byte order mark", "\ufeff" + PLAIN)
read("byte order mark, Windows, semicolons", "\ufeff" + lines(ROWS, ";", end="\r\n"))
read("names in double quotes", lines(ROWS, header=[f'"{name}"' for name in HEADER]))
read("all in double quotes", lines([[f'"{field}"' for field in row] for row in [HEADER, *ROWS]], header=None))
read("all in single quotes", lines([[f"'{field}'" for field in row] for row in [HEADER, *ROWS]], header=None))
read("names in capitals", lines(ROWS, header=["ID", "X", "Y", "Z", "RADIUS"]))
read("names with units", lines(ROWS, header=["id", "x [m]", "y [m]", "z [m]", "radius [m]"]))
read("names with units in quotes and parentheses",
     lines(ROWS, header=["id", '"x (m)"', '"y (m)"', '"z (m)"', '"r (m)"']))
read("columns in another order, and others beside", lines(
    [(row[4], row[3], "steel", row[0], row[1], "7", row[2]) for row in ROWS],
    header=["radius", "z", "material", "id", "x", "type", "y"]))
read("an index without a name (pandas)", lines([(k, *row) for k, row in enumerate(ROWS)], header=["", *HEADER]))
read("columns of ParaView", lines([(*row[1:], row[0]) for row in ROWS],
                                  header=['"Points:0"', '"Points:1"', '"Points:2"', '"radius"', '"id"']))
read("columns pos_x, ...", lines(ROWS, header=["particle_id", "pos_x", "pos_y", "pos_z", "rad"]))
read("diameters", lines(DIAMETERS, header=["id", "x", "y", "z", "diameter"]))
read("diameters called d", lines(DIAMETERS, header=["id", "x", "y", "z", "d"]))
read("no ids", lines([row[1:] for row in ROWS], header=HEADER[1:]), said=("numbered from 1",))
read("comments above, between and below", "# made by a script\n# on a day\n" + changed(50,
     "# half\n" + PLAIN.splitlines()[49] + "\n")
     + "# end\n")
read("names in a comment (numpy.savetxt)", "# " + lines(ROWS, " "))
read("names in a comment with commas", "#" + lines(ROWS))
read("names in a comment, a comma behind them and each line", "# " + PLAIN.replace("\n", ",\n"))
read("names in a comment, a comma behind them alone", "# " + changed(1, PLAIN.splitlines()[0] + ",\n"))
read("names in a comment, a comma behind each line", "# " + changed(1, PLAIN.splitlines()[0] + "\n",
     PLAIN.replace("\n", ",\n")))
read("names in a comment of Matlab", "% " + lines(ROWS, " "))
read("comments of Matlab above", "% made by a script\n" + PLAIN)
read("names in a comment, another below", "# " + lines([], " ", HEADER) + "# in m\n" + lines(ROWS, " ", header=None))
read("the separator named for Excel", "sep=;\n" + lines(ROWS, ";"))
read("lines in another order", lines(ROWS[::-1]), tolerance=1e-11)
read("numbers with a plus sign and exponents",
     lines([(row[0], *(f"+{float(field):.17e}" for field in row[1:])) for row in ROWS]))
read("numbers without the leading zero", lines([(row[0], *(field.lstrip("0") for field in row[1:])) for row in ROWS]))
read("eight digits", lines([(row[0], *(f"{float(field):.8g}" for field in row[1:])) for row in ROWS]), tolerance=1e-6)
read("negative and large ids", lines([(5 - 10**10 * int(row[0]), *row[1:]) for row in ROWS]))
read("velocities 0", lines([(*row, 0, "0.0", "-0") for row in ROWS], header=[*HEADER, "vx", "vy", "vz"]))
read("velocities left out", lines([(*row, 1, 2, 3) for row in ROWS], header=[*HEADER, "vx", "vy", "vz"]), "--at-rest")
read("a comma behind the names alone", changed(1, PLAIN.splitlines()[0] + ",\n"))
read("a column without a name", lines([(*row, "steel") for row in ROWS], header=[*HEADER, ""]))
read("a comma behind each line", PLAIN.replace("\n", ",\n"))
read("a comma behind each line but the first", changed(1, PLAIN.splitlines()[0] + "\n", PLAIN.replace("\n", ",\n")))
refused("decimal commas between semicolons", lines([[field.replace(".", ",") for field in row] for row in ROWS], ";"),
        ":2:", "a number with a comma; write a decimal point")
refused("decimal commas between commas", lines([[field.replace(".", ",") for field in row] for row in ROWS]),
        ":2:", "9 fields instead of 5", "decimal point")
refused("names separated by commas, numbers by blanks", lines([HEADER], header=None) + lines(ROWS, " ", header=None),
        ":2:", "separated by blanks, and the names of the columns by commas")
refused("names separated by blanks, numbers by commas", lines([HEADER], " ", header=None) + lines(ROWS, header=None),
        ":2:", "separated by commas, and the names of the columns by blanks")
refused("no names, five columns", lines(ROWS, header=None), ":1:", "names of the columns are expected")
refused("no radius", lines([row[:4] for row in ROWS], header=HEADER[:4]), ":1:", "column radius is missing")
refused("a name twice", lines([(*row, row[1]) for row in ROWS], header=[*HEADER, "x"]), ":1:",
        "column x is named twice")
refused("two of three velocities", lines([(*row, 0, 0) for row in ROWS], header=[*HEADER, "vx", "vy"]), ":1:",
        "column vz is missing")
refused("a line too short", changed(7, "6,0.5,0.5\n"), ":7:", "3 fields instead of 5")
refused("cut off within a line", PLAIN[:-60], ":101:", "cut off inside this line, after 3 of 5 fields")
refused("cut off within the first field", "".join(PLAIN.splitlines(keepends=True)[:-1]) + "10", ":101:",
        "cut off inside this line, after 1 of 5 fields")
refused("separated by blanks, cut off within the first field",
        "".join(lines(ROWS, " ").splitlines(keepends=True)[:-1]) + "10", ":101:",
        "cut off inside this line, after 1 of 5 fields")
refused("a line of one field", changed(7, "6\n"), ":7:", "1 fields instead of 5")
refused("a title above the names", "My packing\n" + PLAIN, ":1:", "must be named here, not 'My packing'")
refused("units below the names", changed(1, PLAIN.splitlines()[0] + "\n-,m,m,m,m\n"), ":2:", "id is '-'",
        "whole number")
refused("the same id twice", changed(9, PLAIN.splitlines()[7] + "\n"), ":9:", "stands in line 8 too")
refused("a number that is none", changed(5, "4,0.1,NaN,0.3,0.1\n"), ":5:", "y is 'NaN'", "finite number")
refused("a radius of 0", changed(5, "4,0.1,0.2,0.3,0\n"), ":5:", "radius is '0'", "> 0")
refused("an id with decimals", changed(5, "4.0,0.1,0.2,0.3,0.1\n"), ":5:", "id is '4.0'", "whole number")
refused("exponents of Fortran", changed(5, "4,0.1D0,0.2D0,0.3D0,0.1D0\n"), ":5:", "x is '0.1D0'", "finite number")
refused("two tables in one file", PLAIN + PLAIN, ":102:", "id is 'id'", "whole number")
refused("names alone", PLAIN.splitlines()[0] + "\n", "no spheres")
refused("nothing", "", "is empty")
refused("comments alone", "# id x y z radius\n", "is empty")

# ---------------------------------------------------------------------------------------------- units

group("Units")
MILLI = [(row[0], *(repr(1e3 * value) for value in numbers[1:])) for row, numbers in zip(ROWS, NUMBERS)]
read("mm, named by an option", lines(MILLI), "--length-unit", "mm", tolerance=1e-10)
read("mm, the unit as a number", lines(MILLI), "--length-unit", "1e-3", tolerance=1e-10)
read("mm, taken for m", lines(MILLI), flow=["--box", *"0 1000 0 1000 0 1000".split(), *THROUGH_FLOW], factor=1e6,
     tolerance=1e-10, said=("is --length-unit mm missing?",))
read("names with mm, and the option", lines(MILLI, header=["id", "x (mm)", "y (mm)", "z (mm)", "radius (mm)"]),
     "--length-unit", "mm", tolerance=1e-10)
refused("names with mm, no option", lines(MILLI, header=["id", "x (mm)", "y (mm)", "z (mm)", "radius (mm)"]), ":1:",
        "'x (mm)'",
        "--length-unit")
refused("names with cm, and mm as the option",
        lines(MILLI, header=["id", "x (cm)", "y (cm)", "z (cm)", "radius (cm)"]), ":1:",
        "'x (cm)'", "--length-unit", options=("--length-unit", "mm"))
refused("names with m, and mm as the option", lines(MILLI, header=["id", "x [m]", "y [m]", "z [m]", "radius [m]"]),
        ":1:", "'x [m]'",
        "is in m", options=("--length-unit", "mm"))

# -------------------------------------------------------------------------------------------- packed

group("Packed and foreign files")
read("gzip", gzip.compress(PLAIN.encode()))
read("gzip in two parts", gzip.compress(PLAIN[:3000].encode()) + gzip.compress(PLAIN[3000:].encode()))
refused("gzip, cut off", gzip.compress(PLAIN.encode())[:-200], "cut off")
refused("gzip, garbled", gzip.compress(PLAIN.encode())[:-8] + b"\0" * 8, "cannot be unpacked")
refused("bzip2", bz2.compress(PLAIN.encode()), "bzip2", "bunzip2")
refused("xz", lzma.compress(PLAIN.encode()), "xz", "unxz")


def zipped():
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w") as archive:
        archive.writestr("packing.csv", PLAIN)
    return memory.getvalue()


def tarred():
    memory = io.BytesIO()
    with tarfile.open(fileobj=memory, mode="w") as archive:
        member = tarfile.TarInfo("packing.csv")
        member.size = len(PLAIN)
        archive.addfile(member, io.BytesIO(PLAIN.encode()))
    return memory.getvalue()


refused("zip, or a spreadsheet", zipped(), "zip archive or a spreadsheet", "CSV")
refused("tar, packed", gzip.compress(tarred()), "tar archive")
refused("rich text", "{\\rtf1\\ansi\n" + PLAIN + "}", "rich text")
refused("a PDF", "%PDF-1.5\n" + PLAIN, "PDF")
refused("XML of another program", '<?xml version="1.0"?>\n<!DOCTYPE boost_serialization>\n<scene></scene>\n',
        "is XML, but no VTK file")
refused("UTF-16", PLAIN.encode("utf-16"), "UTF-16", "UTF-8")
refused("NumPy's array", b"\x93NUMPY\x01\x00" + b"v\x00{'descr': '<f8'}", "NumPy array")
refused("HDF5", b"\x89HDF\r\n\x1a\n" + bytes(100), "HDF5")
refused("JSON", json.dumps([dict(zip(HEADER, row)) for row in NUMBERS]), "JSON")
refused("numbers without text", struct.pack("400d", *(value for row in NUMBERS for value in row[1:])), "binary")
refused("a web page", "<!DOCTYPE html><html><body>404</body></html>\n", "web page")
refused("an STL mesh", "solid mesh\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
        "endfacet\n"
        "endsolid\n", "STL mesh")
refused("a binary STL mesh", bytes(80) + struct.pack("<I", 1) + bytes(50), "binary")
refused("a log of LIGGGHTS", "LIGGGHTS (Version LIGGGHTS-PUBLIC 3.8.0)\nCreated orthogonal box\n", "log of LIGGGHTS",
        "dump")
refused("a script of LIGGGHTS", "# a column\nunits si\natom_style granular\nboundary f f f\nread_data in.data\n",
        "script", "dump")
refused("an xyz file", "100\ncomment\n" + lines([("Si", *row[1:4]) for row in ROWS], " ", header=None), "xyz")
refused("a report of pfv", '{\n  "permeability": 1.0\n}\n', "JSON")
refused("forces of pfv", "id,fx,fy,fz,fpx,fpy,fpz,fvx,fvy,fvz\n1,0,0,0,0,0,0,0,0,0\n", ":1:", "column x is missing")
refused("a list of files (.pvd)",
        '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1"><Collection/></VTKFile>\n',
        "'Collection'", ".vtu or .vtp")
refused("a drawing", b"\x89PNG\r\n\x1a\n" + bytes(50), "binary")

# ---------------------------------------------------------------------------------------------- dumps

group("Dumps")


def dump(columns="id type x y z radius", rows=None, sides="ff ff ff", step=0, edge=1.0, bounds=None, count=None,
    head=""):
    rows = rows or [(row[0], 1, *row[1:]) for row in ROWS]
    bounds = bounds or f"0 {edge}\n" * 3
    return (f"{head}ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{len(rows) if count is None else count}\n"
            f"ITEM: BOX BOUNDS {sides}\n{bounds}"
            f"ITEM: ATOMS {columns} \n" + "".join(" ".join(map(str, row)) + " \n" for row in rows))


FAR = [(row[0], 1, *(repr(number + (k * 7 + axis) % 3 - 1) for axis, number in enumerate(numbers[1:4])), row[4])
       for k, (row, numbers) in enumerate(zip(ROWS, NUMBERS))]  # some a period away
read("LIGGGHTS", dump())
read("LIGGGHTS, packed", gzip.compress(dump().encode()))
read("as the tutorials write it", dump(
    "id type type x y z ix iy iz vx vy vz fx fy fz omegax omegay omegaz radius",
    [(row[0], 1, 1, *row[1:4], 0, 0, 0, 0, 0, 0, 1, 2, 3, 0, 0, 0, row[4]) for row in ROWS]))
MOVING = dump("id x y z vx vy vz radius", [(*row[:4], 1e-9, 0, 0, row[4]) for row in ROWS])
read("grains that still move", MOVING, factor=None, said=("the grains move", "no permeability is given", "--at-rest"))
read("grains that still move, at rest", MOVING, "--at-rest")
read("diameters of a dump", dump("id type x y z diameter", [(row[0], 1, *row[1:]) for row in DIAMETERS]))
read("scaled coordinates", dump("id type xs ys zs radius"))
read("scaled coordinates in another room", dump("id type xs ys zs radius", [
    (row[0], 1, *(repr((number + 2) / 4) for number in numbers[1:4]), row[4]) for row, numbers in zip(ROWS, NUMBERS)],
    bounds="-2 2\n" * 3), tolerance=1e-9)
read("unwrapped coordinates, periodic", dump("id type xu yu zu radius", FAR, "pp pp pp"), tolerance=1e-9,
     said=("periodic",))
read("scaled unwrapped coordinates, periodic", dump("id type xsu ysu zsu radius", FAR, "pp pp pp"), tolerance=1e-9,
     said=("periodic along x y z, and walls stand there now",))
read("no ids in a dump", dump("x y z radius", [row[1:] for row in ROWS]), said=("numbered from 1",))
read("units and time of newer LAMMPS", dump(head="ITEM: UNITS\nsi\nITEM: TIME\n0.5\n"))
read("tilted, no side periodic", dump(sides="xy xz yz ff ff ff", bounds="0 1.25 0.25\n0 1 0\n0 1 0\n"))
read("tilted and periodic, solved in a box", dump(sides="xy xz yz pp pp pp", bounds="0 1.25 0.25\n0 1 0\n0 1 0\n"),
     said=("periodic along x y z, and walls stand there now",))
MOVED = dump(rows=[(row[0], 1, *(repr(0.9 * number) for number in numbers[1:4]), row[4]) for row,
    numbers in zip(ROWS, NUMBERS)])
CELL = [*THROUGH_FLOW[4:], "--gradient", "0", "0", "-1"]
read("periodic, its own cell", dump(sides="pp pp pp"), flow=CELL, plain=["--periodic", "x,y,z", *UNIT_BOX, *CELL],
     said=("the flow box was taken from it: 0 1 0 1 0 1, periodic",))
read("unwrapped, its own cell", dump("id type xu yu zu radius", FAR, "pp pp pp"), "--periodic", "dump", flow=CELL,
     plain=["--periodic", "x,y,z", *UNIT_BOX, *CELL], tolerance=1e-9,
     said=("the flow box was taken from it: 0 1 0 1 0 1, periodic",))
read("periodic, with another period", dump(sides="pp pp pp"),
     flow=["--periodic", "x,y,z", *UNIT_BOX[:-1], "1.1", *CELL],
     refused=("the length along z of its periodic cell is 1 m", "1.1 m", "--periodic dump"))
read("periodic and tilted, with no tilt", dump(sides="xy xz yz pp pp pp", bounds="0 1.25 0.25\n0 1 0\n0 1 0\n"),
     flow=["--periodic", "x,y,z", *UNIT_BOX, *CELL],
     refused=("the tilt xy of its periodic cell is 0.25 m", "--periodic dump"))
read("a box around the spheres", dump(), "--box", "auto", flow=THROUGH_FLOW, plain=["--box", "auto", *THROUGH_FLOW],
     said=("the flow box was taken from it",))
read("two snapshots, the last", MOVED + dump(step=1000))
read("two snapshots, chosen by the step", dump(step=500) + MOVED.replace("TIMESTEP\n0", "TIMESTEP\n1000"),
     "--snapshot", "500",
     said=("of step 500, number 1 of 2",))
read("two snapshots, chosen by the number", MOVED.replace("TIMESTEP\n0", "TIMESTEP\n100") + dump(step=1000),
     "--snapshot", "2", said=("of step 1000, number 2 of 2",))
read("two snapshots, chosen by the time", dump(step=5, head="ITEM: TIME\n0.25\n") + "ITEM: TIME\n0.5\n" + MOVED,
     "--snapshot", "time=0.25", said=("of step 5, number 1 of 2",))
TIMES = "".join(dump(step=step, head=f"ITEM: UNITS\nsi\nITEM: TIME\n{step / 20}\n") for step in (5, 10)) \
    + "ITEM: UNITS\nsi\nITEM: TIME\n0.75\n" + MOVED.replace("TIMESTEP\n0", "TIMESTEP\n15")
read("units and time before each snapshot", TIMES, "--snapshot", "time=0.5", said=("of step 10, number 2 of 3",))
read("units and time, line ends of Windows", TIMES.replace("\n", "\r\n"), "--snapshot", "time=0.25",
     said=("of step 5, number 1 of 3",))
read("older dump without the kinds of sides", dump(sides="").replace("BOUNDS ", "BOUNDS"))
read("lines of several processes", dump(rows=[(row[0], 1, *row[1:]) for row in ROWS[50:] + ROWS[:50]]), tolerance=1e-11)
read("the last cut off, an earlier one chosen", dump(step=10) + dump(step=20)[:-2000], "--snapshot", "10",
     said=("of step 10, number 1 of 2",))
refused("the last cut off within a line", dump(step=10) + dump(step=20)[:-2000], ":196:", "cut off inside this line")
refused("the last cut off between lines", dump(step=10) + "".join(dump(step=20).splitlines(keepends=True)[:60]),
        "cut off after 51 of 100 atoms", "--snapshot")
refused("cut off within the last number", dump()[:-8], "ends inside this line", "cut off")
refused("cut off before its atoms", dump()[:60], "cut off")
refused("a dump from before the grains were poured", dump(count=0).partition("ITEM: ATOMS")[0] + "ITEM: ATOMS id x y z radius\n",
        "of step 0 has no atoms", "later step")
refused("no such snapshot", dump(step=10) + dump(step=20), "no snapshot '15'", "10 20", options=("--snapshot", "15"))
refused("a snapshot of a table", PLAIN, "is no dump", options=("--snapshot", "1"))
refused("more atoms than it names", dump(count=50), "more lines than the 50 atoms")
refused("no radii in a dump", dump("id type x y z", [(row[0], 1, *row[1:4]) for row in ROWS]),
        "column radius is missing")
refused("units lj", dump(head="ITEM: UNITS\nlj\n"), ":2:", "units are 'lj'", "--length-unit")
refused("tilted and scaled", dump("id type xs ys zs radius", sides="xy xz yz pp pp pp",
        bounds="0 1.25 0.25\n0 1 0\n0 1 0\n"),
        "scaled", "tilted")
refused("a general triclinic cell", dump(sides="abc origin pp pp pp", bounds="1 0 0 0\n0 1 0 0\n0 0 1 0\n"),
        "general triclinic")
refused("a dump of contacts", "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ENTRIES\n1\nITEM: BOX BOUNDS ff ff ff\n" + "0 1\n" * 3
        + "ITEM: ENTRIES c_1[1] c_1[2]\n1 2\n", "contacts", "ITEM: ENTRIES")

# ------------------------------------------------------------------------------------- YADE, data, VTK

group("YADE, data files, VTK")
XYZR = lines([row[1:] for row in ROWS], "\t", header=None)
read("YADE's text", "#format x_y_z_r\n" + XYZR, said=("numbered from 1",))
read("YADE's text without its first line", XYZR, said=("taken as x, y, z and radius",))
read("YADE's text with materials", "#format x_y_z_r_matId\n" + lines([(*row[1:], 0) for row in ROWS], "\t",
     header=None), said=("numbered from 1",))
GRANULAR = [(row[0], 1, row[4], 2500, *row[1:4]) for row in DIAMETERS]


def data(rows, mark="", tail="", count=None):
    return (f"LIGGGHTS data file\n\n{len(rows) if count is None else count} atoms\n1 atom types\n\n"
            f"0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nAtoms{mark}\n\n"
            + lines(rows, " ", header=None) + tail)


read("LIGGGHTS data file", data(GRANULAR))
read("LAMMPS data file, style sphere", data(GRANULAR, " # sphere"))
read("data file with image numbers", data([(*row, 0, 0, -1) for row in GRANULAR]))
read("data file with velocities 0", data(GRANULAR,
     tail="\nVelocities\n\n" + lines([(row[0], *"000000") for row in ROWS], " ", header=None)))
read("data file with Windows' line ends", data(GRANULAR).replace("\n", "\r\n"))
refused("data file of another style", data([(row[0], 1, *row[1:4]) for row in ROWS], " # atomic"), "style 'atomic'",
        "radii")
refused("data file cut off", data(GRANULAR)[:-4000], "cut off inside this line, after 5 of 7 fields")
refused("data file with too few atoms", data(GRANULAR, count=120), "cut off after 100 of 120 atoms")
refused("data file without its last line end", data(GRANULAR)[:-1], "ends inside this line")


def legacy(values, name="radius", points=None, kind="ASCII", text=None):
    points = points or ROWS
    return (f"# vtk DataFile Version 3.0\nspheres\n{kind}\nDATASET POLYDATA\nPOINTS {len(points)} double\n"
            + lines([row[1:4] for row in points], " ", header=None) + (text if text is not None else
            f"POINT_DATA {len(points)}\nSCALARS {name} double 1\nLOOKUP_TABLE default\n" + "\n".join(values) + "\n"))


RADII, TWICE = [row[4] for row in ROWS], [row[4] for row in DIAMETERS]


def vtu(arrays, kind="UnstructuredGrid", points=ROWS, pieces=1):
    fields = "".join(f'<DataArray type="Float64" Name="{name}" format="ascii">{" ".join(values)}</DataArray>'
                     for name, values in arrays.items())
    places = " ".join(field for row in points for field in row[1:4])
    piece = (f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="0"><Points>'
             f'<DataArray type="Float64" NumberOfComponents="3" format="ascii">{places}</DataArray></Points>'
             f'<PointData>{fields}</PointData></Piece>')
    return (f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian"><{kind}>'
            f'{piece * pieces}</{kind}></VTKFile>\n')


read("legacy VTK (LPP)", legacy(RADII), said=("numbered from 1",))
read("legacy VTK with other fields, as of LIGGGHTS", legacy(RADII, text=f"VERTICES 100 200\n" + "".join(
    f"1 {k}\n" for k in range(100)) + "POINT_DATA 100\nVECTORS f float\n" + "0 0 1\n" * 100 + "SCALARS type int 1\n"
    "LOOKUP_TABLE default\n" + "1\n" * 100 + "FIELD FieldData 2\nid 1 100 int\n" + " ".join(row[0] for row in ROWS)
    + "\nradius 1 100 double\n" + " ".join(RADII) + "\nMETADATA\nINFORMATION 0\n\n"))
read("legacy VTK without its last line end, other numbers behind", legacy(RADII) + "METADATA\nINFORMATION 0",
     said=("numbered from 1",))
read("legacy VTK with diameters", legacy(TWICE, "diameter"), said=("numbered from 1",))
read(".vtu", vtu({"radius": RADII, "id": [row[0] for row in ROWS]}))
read(".vtu of YADE", vtu({"radii": RADII}), said=("numbered from 1",))
read(".vtu, packed", gzip.compress(vtu({"radius": RADII}).encode()), said=("numbered from 1",))
read(".vtp", vtu({"diameter": TWICE}, "PolyData"), said=("numbered from 1",))
refused("legacy VTK, binary", legacy(RADII, kind="BINARY"), "binary legacy VTK", "ASCII")
refused("legacy VTK, the bounding box of LIGGGHTS", "# vtk DataFile Version 5.1\nGenerated by LIGGGHTS\nASCII\n"
        "DATASET RECTILINEAR_GRID\nDIMENSIONS 2 2 2\nX_COORDINATES 2 float\n0 1\n", "RECTILINEAR_GRID", "bounding box")
refused("legacy VTK without radii", legacy([], text=""), "no radius or diameter")
refused(".vtu without radii", vtu({"pressure": RADII}), "no radius or diameter", "pressure")
refused(".vtu with too few radii", vtu({"radius": RADII[:99]}), "99 values for 100 points")
refused(".vtu in two pieces", vtu({"radius": RADII}, pieces=2), "several pieces")
refused(".vti, an image", vtu({"radius": RADII}, "ImageData"), "ImageData", ".vtu or .vtp")
refused(".vtu, cut off", vtu({"radius": RADII})[:-3000], "no whole XML file")
refused("legacy VTK, cut off within the last number", legacy(RADII)[:-3], "last number may be cut off")
refused("legacy VTK, cut off within a keyword", legacy(RADII) + "VECTO", "last word may be cut off")
refused("legacy VTK, cut off", legacy(RADII)[:-2500], "cut off")
