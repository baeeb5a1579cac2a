"""Writes the meshes beside it with gmsh (pip install gmsh) and prints what gmsh says of them.

Three shapes: `plate`, a unit square with a round hole, in two regions; `strip`, 2 m x 0.5 m, left half of quadrilaterals, right half of
triangles; `turned`, a rectangle at z = 2 m whose surface looks down, so that its cells run clockwise. Files with `big` are those of the
same name with `little`, of the other byte order: gmsh writes the machine's only.
"""

import json
import struct
import sys

import gmsh


def plate(order):
    geo = gmsh.model.geo
    h = 0.3
    corners = [geo.addPoint(x, y, 0, h) for x, y in [(0, 0), (0.5, 0), (1, 0), (1, 1), (0.5, 1), (0, 1)]]
    centre = geo.addPoint(0.25, 0.5, 0, h)
    rim = [geo.addPoint(0.25 + 0.12 * x, 0.5 + 0.12 * y, 0, h) for x, y in [(1, 0), (0, 1), (-1, 0), (0, -1)]]
    side = [geo.addLine(corners[i], corners[(i + 1) % 6]) for i in range(6)]
    middle = geo.addLine(corners[1], corners[4])
    arcs = [geo.addCircleArc(rim[i], centre, rim[(i + 1) % 4]) for i in range(4)]
    left = geo.addPlaneSurface([geo.addCurveLoop([side[0], middle, side[4], side[5]]), geo.addCurveLoop(arcs)])
    right = geo.addPlaneSurface([geo.addCurveLoop([side[1], side[2], side[3], -middle])])
    geo.synchronize()
    gmsh.model.addPhysicalGroup(2, [left], 7, "steel plate")
    gmsh.model.addPhysicalGroup(2, [right], 3, "rubber")
    gmsh.model.addPhysicalGroup(1, [side[5]], 7, "clamped")
    gmsh.model.addPhysicalGroup(1, arcs, 9, "hole")
    gmsh.model.addPhysicalGroup(0, [corners[3]], 1, "corner")
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(order)


def strip(incomplete):
    geo = gmsh.model.geo
    h = 0.25
    points = [geo.addPoint(x, y, 0, h) for x, y in [(0, 0), (1, 0), (2, 0), (2, 0.5), (1, 0.5), (0, 0.5)]]
    side = [geo.addLine(points[i], points[(i + 1) % 6]) for i in range(6)]
    middle = geo.addLine(points[1], points[4])
    left = geo.addPlaneSurface([geo.addCurveLoop([side[0], middle, side[4], side[5]])])
    right = geo.addPlaneSurface([geo.addCurveLoop([side[1], side[2], side[3], -middle])])
    for curve, n in [(side[0], 5), (side[4], 5), (middle, 3), (side[5], 3)]:
        geo.mesh.setTransfiniteCurve(curve, n)
    geo.mesh.setTransfiniteSurface(left)
    geo.mesh.setRecombine(2, left)
    geo.synchronize()
    gmsh.model.addPhysicalGroup(2, [left], 1, "left")
    gmsh.model.addPhysicalGroup(2, [right], 2, "right")
    gmsh.model.addPhysicalGroup(2, [left, right], 4)
    gmsh.model.addPhysicalGroup(1, [side[5]], 5, "clamped")
    gmsh.model.addPhysicalGroup(1, [side[2]], 6, "tip")
    gmsh.model.mesh.generate(2)
    if incomplete:
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
        gmsh.model.mesh.setOrder(2)


def grid(turned, order=1):
    geo = gmsh.model.geo
    z = 2.0 if turned else 0.0
    points = [geo.addPoint(x, y, z) for x, y in [(0, 0), (1.2, 0), (1.2, 0.4), (0, 0.4)]]
    side = [geo.addLine(points[i], points[(i + 1) % 4]) for i in range(4)]
    loop = geo.addCurveLoop([-side[3], -side[2], -side[1], -side[0]] if turned else side)
    surface = geo.addPlaneSurface([loop])
    for curve, n in zip(side, [7, 3, 7, 3]):
        geo.mesh.setTransfiniteCurve(curve, n)
    geo.mesh.setTransfiniteSurface(surface)
    geo.mesh.setRecombine(2, surface)
    geo.synchronize()
    gmsh.model.addPhysicalGroup(2, [surface], 1, "beam")
    gmsh.model.addPhysicalGroup(1, [side[3]], 2, "clamped")
    gmsh.model.mesh.generate(2)
    if order == 2:
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
        gmsh.model.mesh.setOrder(2)


SHAPES = {
    "plate_tri3": lambda: plate(1),
    "plate_tri6": lambda: plate(2),
    "grid_quad4": lambda: grid(False),
    "grid_quad8": lambda: grid(False, 2),
    "strip_mixed": lambda: strip(False),
    "turned": lambda: grid(True),
}
FILES = [
    ("plate_tri3", 2.2, 0), ("plate_tri3", 2.2, 1), ("plate_tri3", 4.1, 0), ("plate_tri3", 4.1, 1),
    ("plate_tri6", 2.2, 0), ("plate_tri6", 4.1, 1),
    ("grid_quad4", 2.2, 1), ("grid_quad4", 4.1, 0),
    ("grid_quad8", 4.1, 0),
    ("strip_mixed", 2.2, 0), ("strip_mixed", 2.2, 1), ("strip_mixed", 4.1, 1),
    ("turned", 2.2, 1), ("turned", 4.1, 0),
]


def facts():
    """What gmsh itself counts: cells and area by physical surface, nodes by physical curve and point."""
    told = {}
    for dim, tag in gmsh.model.getPhysicalGroups():
        name = gmsh.model.getPhysicalName(dim, tag) or str(tag)
        if dim == 2:
            n, area = 0, 0.0
            for entity in gmsh.model.getEntitiesForPhysicalGroup(2, tag):
                for kind, tags, _ in zip(*gmsh.model.mesh.getElements(2, entity)):
                    n += len(tags)
                    points, weights = gmsh.model.mesh.getIntegrationPoints(kind, "Gauss4")
                    _, jacobians, _ = gmsh.model.mesh.getJacobians(kind, points, entity)
                    area += sum(w * j for w, j in zip(list(weights) * len(tags), jacobians))
            told[name] = [n, round(area, 12)]
        else:
            told[name] = len(gmsh.model.mesh.getNodesForPhysicalGroup(dim, tag)[0])
    return told


def swapped(data):
    """The same binary file in the other byte order."""
    out, at = bytearray(), 0

    def line():
        nonlocal at
        end = data.index(b"\n", at) + 1
        text = data[at:end]
        out.extend(text)
        at = end
        return text

    def take(kinds):
        nonlocal at
        values = struct.unpack_from("<" + kinds, data, at)
        at += struct.calcsize("<" + kinds)
        out.extend(struct.pack(">" + kinds, *values))
        return values

    nodes_of = {1: 2, 2: 3, 3: 4, 8: 3, 9: 6, 15: 1, 16: 8}
    version = None
    while at < len(data):
        text = line().strip()
        if text == b"$MeshFormat":
            version = line().split()[0]
            take("i")
        elif text == b"$Nodes" and version == b"2.2":
            for _ in range(int(line())):
                take("i3d")
        elif text == b"$Elements" and version == b"2.2":
            left = int(line())
            while left:
                kind, n, n_tags = take("3i")
                for _ in range(n):
                    take("%di" % (1 + n_tags + nodes_of[kind]))
                left -= n
        elif text == b"$PhysicalNames":
            for _ in range(int(line())):
                line()
        elif text == b"$Entities":
            counts = take("4Q")
            for dim, count in enumerate(counts):
                for _ in range(count):
                    take("i3d" if dim == 0 else "i6d")
                    take("%di" % take("Q")[0])
                    if dim:
                        take("%di" % take("Q")[0])
        elif text == b"$Nodes":
            for _ in range(take("4Q")[0]):
                n = take("3iQ")[3]
                take("%dQ" % n)
                take("%dd" % (3 * n))
        elif text == b"$Elements":
            for _ in range(take("4Q")[0]):
                _, _, kind, n = take("3iQ")
                take("%dQ" % (n * (1 + nodes_of[kind])))
    return bytes(out)


def main():
    for name, version, binary in FILES:
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        SHAPES[name]()
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", binary)
        stem = "%s_%s_" % (name, str(version).replace(".", ""))
        path = stem + ("little" if binary else "ascii") + ".msh"
        gmsh.write(path)
        print(path, json.dumps(facts()))
        gmsh.finalize()
        if binary and name in ("plate_tri6", "strip_mixed"):
            with open(path, "rb") as file:
                data = file.read()
            with open(stem + "big.msh", "wb") as file:
                file.write(swapped(data))


if __name__ == "__main__":
    sys.exit(main())
