"""Checks spinneb's files with the packages that others use: check.py SPINNEB PAGE

Both directions, number by number: what spinneb writes is read with numpy, vtk, discretisedfield and libovf, and what these write
spinneb takes as initial states and paths. Last, the example in Python of the page, which reads a result, runs on one.
"""

import importlib
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

SITES = 24
SINGLE = float(np.finfo(np.float32).eps)


# every kind of film and crystal, with vacancies and without
FILMS = {
    "square": {"square": {"cells": [9, 7], "spacing": "0.5 nm", "shape": {"disc": {"radius": 3.2}}, "vacant": [3]}},
    "grid": {"grid": {"cells": [8, 6, 2], "cell": ["2 nm", "3 nm", "0.6 nm"], "vacant": [0, 50]}},
    "honeycomb": {"honeycomb": {"cells": [6, 5], "spacing": "0.3 nm", "vacant": [7]}},
    "hcp": {"hcp": {"cells": [4, 3, 2], "spacing": "0.3 nm"}},
    "cubic": {"cubic": {"cells": [4, 3, 3], "spacing": "0.4 nm", "vacant": [5]}},
}


def optional(name):
    try:
        return importlib.import_module(name)
    except ImportError as e:
        print(f"  not checked: {name} ({e})")
        return None


def config(**more):
    up, down = ({"uniform": {"direction": [0, 0, z]}} for z in (1, -1))
    terms = [{"exchange": {"J": ["10 meV"]}}, {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}]
    chain = {"sites": SITES, "spacing": "0.5 nm", "cross_section": ["2 nm", "1 nm"]}
    base = {"material": {"name": "toy", "energy": terms}, "lattice": {"chain": chain}, "initial": up, "final": down}
    return base | {"output": {"formats": [], "plots": []}} | more


def run(spinneb, folder, name, content, codes=(0,)):
    (folder / f"{name}.json").write_text(json.dumps(content))
    done = subprocess.run([spinneb, "run", f"{name}.json", "--quiet"], cwd=folder, capture_output=True, text=True)
    assert done.returncode in codes, f"{name}: exit code {done.returncode}: {done.stderr}"
    return folder / "results" / name


def same(what, found, expected, tolerance=0.0):
    found, expected = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    assert found.shape == expected.shape, f"{what}: shape {found.shape}, expected {expected.shape}"
    error = float(np.max(np.abs(found - expected)))
    assert error <= tolerance, f"{what}: off by {error}"
    print(f"  {what}: {'exact' if tolerance == 0.0 else f'within {error:.1e}'}")


def numpy_reads(result):
    npz = np.load(result / "path.npz")
    spins = npz["spins"]
    assert spins.dtype == np.float64 and spins.ndim == 3 and np.allclose(np.linalg.norm(spins, axis=2), 1.0, atol=1e-15)
    table = np.genfromtxt(result / "path.csv", delimiter=",", names=True)
    for column in table.dtype.names[1:]:
        same(f"numpy, path.npz against path.csv: {column}", npz[column], table[column])
    rows = np.loadtxt(result / "spins.csv", delimiter=",", skiprows=2)
    same("numpy, spins.csv", rows[:, 2:].reshape(spins.shape), spins)
    return spins


def vtk_reads(result, spins):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    listed = re.findall(r'file="([^"]+)"', (result / "path.pvd").read_text())
    assert len(listed) == len(spins)
    images = []
    for name in listed:
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(result / name))
        reader.Update()
        data = reader.GetOutput()
        assert data.GetNumberOfPoints() == SITES and data.GetNumberOfLines() == 1 and data.GetNumberOfVerts() == SITES
        images.append(vtk_to_numpy(data.GetPointData().GetVectors()))
        positions = vtk_to_numpy(data.GetPoints().GetData())
    same("vtk, spins", images, spins)
    same("vtk, positions (nm)", positions[:, 0], 0.5 * (np.arange(SITES) + 0.5))


def discretisedfield_reads(df, result, spins):
    names = sorted(f"ovf/{path.name}" for path in (result / "ovf").iterdir())
    fields = [df.Field.from_file(str(result / name)) for name in names]
    same("discretisedfield, ovf/image_….ovf", [f.array[:, 0, 0, :] for f in fields], spins)
    same("discretisedfield, cell (m)", fields[0].mesh.cell, [0.5e-9, 2e-9, 1e-9], 1e-24)


def libovf_reads(ovf, result, spins):
    for file, tolerance in [("path.ovf", 0.0), ("path_text.ovf", 0.0), ("path_binary4.ovf", SINGLE)]:
        found = np.zeros_like(spins)
        with ovf.ovf_file(str(result / file)) as handle:
            assert handle.found and handle.is_ovf and handle.n_segments == len(spins), file
            for k in range(len(spins)):
                segment = ovf.ovf_segment()
                assert handle.read_segment_header(k, segment) == ovf.OK, handle.get_latest_message()
                data = np.zeros((SITES, 3))
                assert handle.read_segment_data(k, segment, data) == ovf.OK, handle.get_latest_message()
                found[k] = data
        same(f"libovf, {file}", found, spins, tolerance)


def film(lattice):
    """A short path on a film, written in all formats."""
    [kind] = lattice
    grid = {"exchange": {"A": "10 pJ/m"}}, {"anisotropy": {"K": "50 kJ/m^3", "axis": [0, 0, 1]}}
    atoms = {"exchange": {"J": ["10 meV"]}}, {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}
    formats = ["csv", "npz", "ovf", "ovf_binary4", "ovf_text", "ovf_images", "spins_csv", "vtk"]
    material = {"name": "toy", "energy": list(grid if kind == "grid" else atoms)} | ({"Ms": "800 kA/m"} if kind == "grid" else {})
    path = {"images": 5, "guess": {"sweep": {"from": [1, 0.3, 0]}}}
    few = {"neb": {"max_evaluations": 3}, "saddle": {"refine": False, "certify": False}, "relax_ends": False}
    return config(lattice=lattice, material=material, path=path, output={"formats": formats, "plots": []}, **few)


def films(spinneb, folder, df):
    """Positions, meshes and cells of films and crystals, and their files read back as states and paths."""
    for kind, lattice in FILMS.items():
        result = run(spinneb, folder, kind, film(lattice), codes=(0, 3))
        npz = np.load(result / "path.npz")
        spins, places = npz["spins"], npz["positions_nm"]
        vacant = lattice[kind].get("vacant", [])
        there = np.setdiff1d(np.arange(len(places)), vacant)
        table = np.genfromtxt(result / "path.csv", delimiter=",", names=True)
        same(f"{kind}: numpy, charge", npz["charge"], table["charge"])
        vtk_film(kind, result, spins, places, there)
        if df and kind in ("square", "grid"):
            df_film(df, kind, result, lattice, spins, places, there)
        elif kind not in ("square", "grid", "cubic"):
            rows = [line.split() for line in (result / "ovf/image_002.ovf").read_text().splitlines() if not line.startswith("#")]
            numbers = np.array(rows, dtype=float)
            same(f"{kind}: irregular ovf, positions (nm)", 1e9 * numbers[:, :3], places, 1e-12)
            same(f"{kind}: irregular ovf, spins", numbers[there, 3:], spins[2, there])
        for file in ["path.ovf", "path_text.ovf", "path_binary4.ovf", "path.npz"]:
            again = film(lattice) | {"initial": {"file": {"path": f"results/{kind}/{file}", "segment": 2}}}
            again["path"] = {"images": 5, "guess": {"file": {"path": f"results/{kind}/{file}"}}}
            back = run(spinneb, folder, f"{kind}_{file}", again, codes=(0, 3))
            tolerance = SINGLE if "binary4" in file else 0.0
            same(f"{kind}: spinneb, {file}", np.load(back / "inputs/initial.npy")[there], spins[2, there], tolerance)
            same(f"{kind}: spinneb, {file} as a path", np.load(back / "inputs/guess.npy")[:, there], spins[:, there], tolerance)


def vtk_film(kind, result, spins, places, there):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

    is_solid = kind in ("grid", "cubic")
    reader = vtkXMLUnstructuredGridReader() if is_solid else vtkXMLPolyDataReader()
    reader.SetFileName(str(result / ("vtk/image_002.vtu" if is_solid else "vtk/image_002.vtp")))
    assert f'file="{"/".join(reader.GetFileName().split("/")[-2:])}"' in (result / "path.pvd").read_text()
    reader.Update()
    data = reader.GetOutput()
    assert data.GetNumberOfPoints() == len(places)
    if is_solid:
        vtk_solid(kind, data, places, there)
    else:
        assert data.GetNumberOfVerts() == len(places) and data.GetNumberOfLines() == 0
    same(f"{kind}: vtk, positions (nm)", vtk_to_numpy(data.GetPoints().GetData()), places)
    expected = spins[2].copy()
    expected[np.setdiff1d(np.arange(len(places)), there)] = 0.0
    same(f"{kind}: vtk, spins", vtk_to_numpy(data.GetPointData().GetVectors()), expected)
    if kind in ("square", "honeycomb"):
        corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        assert len(corners) > len(places) / 2 and np.isin(corners, there).all()
        m = spins[2][corners]
        a, b, c = m[:, 0], m[:, 1], m[:, 2]
        below = 1 + (a * b + b * c + c * a).sum(1)
        solid = 2 * np.arctan2((a * np.cross(b, c)).sum(1), below)
        charge = np.genfromtxt(result / "path.csv", delimiter=",", names=True)["charge"][2]
        same(f"{kind}: vtk, charge of its triangles", solid.sum() / (4 * np.pi), charge, 1e-12)
    elif not is_solid:
        assert data.GetNumberOfPolys() == 0


def vtk_solid(kind, data, places, there):
    """A vertex a site, and hexahedra that fill the box between the outermost sites, where no corner is vacant."""
    corners, volumes = [], []
    for k in range(data.GetNumberOfCells()):
        cell = data.GetCell(k)  # the same object each time
        assert cell.GetClassName() == ("vtkVertex" if k < len(places) else "vtkHexahedron")
        if k >= len(places):
            corners.append([cell.GetPointId(i) for i in range(8)])
            volumes.append(vtk_volume(cell))
    corners = np.array(corners)
    assert np.isin(corners, there).all()
    vacant = places[np.setdiff1d(np.arange(len(places)), there)]
    steps = [np.unique(np.round(places[:, d], 9)) for d in range(3)]
    boxes = np.array(np.meshgrid(*[(s[1:] + s[:-1]) / 2 for s in steps], indexing="ij")).reshape(3, -1).T
    half = np.array([(s[1] - s[0]) / 2 for s in steps])
    whole = [b for b in boxes if not (np.abs(vacant - b) < 1.01 * half).all(axis=1).any()]
    middles = places[corners].mean(axis=1)
    same(f"{kind}: vtk, hexahedra", sorted(map(tuple, np.round(middles, 9))), sorted(map(tuple, np.round(whole, 9))), 1e-9)
    same(f"{kind}: vtk, volumes (nm³)", volumes, np.full(len(whole), 8 * half.prod()), 1e-9)


def vtk_volume(cell):
    """The volume of a cell by VTK's own tetrahedra."""
    from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints

    ids, points = vtkIdList(), vtkPoints()
    points.SetDataTypeToDouble()
    cell.Triangulate(0, ids, points)
    p = np.array([points.GetPoint(i) for i in range(points.GetNumberOfPoints())]).reshape(-1, 4, 3)
    return abs(np.linalg.det(p[:, 1:] - p[:, :1])).sum() / 6


def df_film(df, kind, result, lattice, spins, places, there):
    names = sorted(f"ovf/{path.name}" for path in (result / "ovf").iterdir())
    fields = [df.Field.from_file(str(result / name)) for name in names]
    cells = lattice[kind]["cells"]
    mesh = fields[0].mesh
    assert list(mesh.n) == cells + [1] * (3 - len(cells)), mesh.n
    edges = [float(edge.split()[0]) for edge in lattice[kind].get("cell", ["0.5 nm"] * 3)]
    same(f"{kind}: discretisedfield, cell (nm)", 1e9 * np.array(mesh.cell), edges, 1e-12)
    for k, field in enumerate(fields):
        found = np.array([field(1e-9 * place) for place in places[there]])
        same(f"{kind}: discretisedfield, image {k} at every site", found, spins[k, there])
        filled = (np.abs(field.array).sum(axis=-1) > 0).sum()
        assert filled == len(there), f"{filled} cells have a spin, not {len(there)}"


class Reader:
    """Lets spinneb read a file as the initial state, and compares what it kept of it."""

    def __init__(self, spinneb, folder, spins):
        self.spinneb, self.folder, self.spins, self.count = spinneb, folder, spins, 0

    def state(self, what, file, segment, expected, tolerance=0.0):
        self.count += 1
        initial = {"file": {"path": file} | ({} if segment is None else {"segment": segment})}
        content = config(initial=initial, relax_ends=False, neb={"max_evaluations": 1})
        result = run(self.spinneb, self.folder, f"read_{self.count}", content, codes=(0, 3))
        same(f"spinneb, {what}", np.load(result / "inputs/initial.npy"), expected, tolerance)

    def path(self, what, file):
        self.count += 1
        content = config(path={"images": len(self.spins), "guess": {"file": {"path": file}}})
        result = run(self.spinneb, self.folder, f"read_{self.count}", content)
        same(f"spinneb, {what}", np.load(result / "inputs/guess.npy"), self.spins)


def numpy_writes(reader, folder, spins):
    image = spins[3]
    np.save(folder / "a.npy", image)
    reader.state("numpy.save", "a.npy", None, image)
    np.save(folder / "b.npy", np.asfortranarray(spins).astype(">f4"))
    reader.state("numpy.save, Fortran order, big-endian float32", "b.npy", 3, image, SINGLE)
    np.savez(folder / "c.npz", energy=np.zeros(3), spins=spins)
    reader.path("numpy.savez", "c.npz")
    np.savez_compressed(folder / "d.npz", m=spins)
    reader.state("numpy.savez_compressed", "d.npz", -6, image)
    np.savetxt(folder / "e.txt", image, fmt="%.17g", header="mx my mz")
    reader.state("numpy.savetxt", "e.txt", None, image, 4e-16)
    np.savetxt(folder / "f.csv", image, delimiter=",", header="m_x,m_y,m_z", comments="")
    reader.state("numpy.savetxt with commas", "f.csv", None, image, 4e-16)


def discretisedfield_writes(df, reader, folder, spins):
    mesh = df.Mesh(p1=(0, 0, 0), p2=(SITES * 1e-9, 1e-9, 1e-9), n=(SITES, 1, 1))
    field = df.Field(mesh, nvdim=3, value=spins[3].reshape(SITES, 1, 1, 3))
    for representation, tolerance in [("txt", 1e-15), ("bin4", SINGLE), ("bin8", 0.0)]:
        field.to_file(str(folder / f"df_{representation}.omf"), representation=representation)
        reader.state(f"discretisedfield, {representation}", f"df_{representation}.omf", None, spins[3], tolerance)
    magnetisation = df.Field(mesh, nvdim=3, value=8e5 * field.array)
    magnetisation.to_file(str(folder / "df_Ms.ovf"), representation="bin8")
    reader.state("discretisedfield, A/m", "df_Ms.ovf", None, spins[3], 4e-16)


def libovf_writes(ovf, reader, folder, spins):
    # libovf prints 12 digits after the point
    for name, tolerance in [("BIN8", 0.0), ("BIN4", SINGLE), ("TEXT", 1e-12), ("CSV", 1e-12)]:
        file = folder / f"libovf_{name}.ovf"
        kind = getattr(ovf, f"FILEFORMAT_{name}")
        for k, image in enumerate(spins[:5]):
            with ovf.ovf_file(str(file)) as handle:
                segment = ovf.ovf_segment(n_cells=[SITES, 1, 1], valuedim=3)
                write = handle.append_segment if k else handle.write_segment
                assert write(segment, np.ascontiguousarray(image), fileformat=kind) == ovf.OK, handle.get_latest_message()
        reader.state(f"libovf, {name}", file.name, 3, spins[3], tolerance)


def notebook(page, result):
    blocks = re.findall(r"```python\n(.*?)```", page.read_text(), flags=re.S)
    blocks = [block for block in blocks if "path.npz" in block]  # those of the package are run with its own tests
    assert len(blocks) == 1, "the page has one example of files in Python"
    assert len(blocks[0].splitlines()) <= 15, "it has more than 15 lines"
    written = set(result.iterdir())
    code = blocks[0].replace("results/wall_nucleation", str(result))
    assert str(result) in code, "it reads results/wall_nucleation"
    subprocess.run([sys.executable, "-c", code], cwd=result, check=True)
    [figure] = set(result.iterdir()) - written
    assert figure.read_bytes().startswith(b"\x89PNG") and figure.stat().st_size > 5000
    print(f"  the book's example in Python: {figure.name}")


def landscape(spinneb, folder, config, pygt, nx):
    """The network of a landscape as PyGT and networkx read it: its times are those of lifetimes.csv."""
    out = folder / "landscape"
    done = subprocess.run([spinneb, "landscape", config, "--out", out, "--quiet"], capture_output=True, text=True)
    assert done.returncode == 0, f"landscape: exit code {done.returncode}: {done.stderr}"
    mean = np.genfromtxt(out / "minima.csv", delimiter=",", names=True)["mean_spin_z"]
    lines = [line.split(",") for line in (out / "lifetimes.csv").read_text().splitlines()]
    column = lines[0].index("langer_time_s")
    kelvin = float(lines[1][2])
    times = {(row[0], row[1]): float(row[column]) for row in lines[1:] if float(row[2]) == kelvin}
    if nx:
        graph = nx.read_graphml(out / "landscape.graphml")
        saddles = (out / "saddles.csv").read_text().count("\n") - 1
        assert (graph.number_of_nodes(), graph.number_of_edges()) == (len(mean), saddles), "landscape.graphml"
    if pygt:
        rates = pygt.io.load_ktn(str(out), beta=1 / (8.617333262e-2 * kelvin))
        onward, kept = np.array(rates[1].todense()).T, rates[7]
        assert kept.all(), "PyGT leaves states out"
        onward -= np.diag(onward.sum(axis=1))
        for start, goal, sign in [("up", "down", 1.0), ("down", "up", -1.0)]:
            inner = np.flatnonzero(sign * mean > -0.95)
            passage = np.linalg.solve(onward[np.ix_(inner, inner)], -np.ones(len(inner)))
            found = float(np.mean(passage[sign * mean[inner] > 0.95]))
            expected = times[(f'"{start}"', f'"{goal}"')]
            assert abs(found / expected - 1) < 1e-9, f"from {start} to {goal}: {found} s, {expected} s"


def main():
    spinneb, page = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    df, ovf = optional("discretisedfield"), optional("ovf.ovf")
    pygt, nx = optional("PyGT"), optional("networkx")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        formats = ["csv", "npz", "ovf", "ovf_binary4", "ovf_text", "ovf_images", "spins_csv", "vtk"]
        guess = {"images": 9, "guess": {"sweep": {"from": "left"}}}
        result = run(spinneb, folder, "wall", config(path=guess, output={"formats": formats, "plots": []}))
        spins = numpy_reads(result)
        vtk_reads(result, spins)
        if df:
            discretisedfield_reads(df, result, spins)
        if ovf:
            libovf_reads(ovf, result, spins)
        reader = Reader(spinneb, folder, spins)
        numpy_writes(reader, folder, spins)
        if df:
            discretisedfield_writes(df, reader, folder, spins)
        if ovf:
            libovf_writes(ovf, reader, folder, spins)
        films(spinneb, folder, df)
        landscape(spinneb, folder, page.parents[2] / "configs/landscapes/ring.json", pygt, nx)
        notebook(page, result)
    print("interoperability: checked" + "".join(f", but not with {n}" for n, m in [("discretisedfield", df), ("libovf", ovf), ("PyGT", pygt), ("networkx", nx)] if not m))


main()
