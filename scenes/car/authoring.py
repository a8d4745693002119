"""Control cages and the tree of parts, as make_car.py's modules build them in Blender, and how they become car.json.

A cage is a mesh of quads whose limit (Catmull-Clark) is the surface meant. Metres; y is up."""

import json
import math

import bmesh
from mathutils import Matrix, Vector

UNIT = 0.0001  # of a point's coordinates in car.json, metres
FINE = 100_000  # triangles: the car has to have so many for its small parts to be worth their own
SMALL = 0.16  # metres
HARD = 10.0  # the sharpness of an edge that stays one at every level


class Cage:
    """A bmesh of quads with creases and, where asked, texture coordinates at its points."""

    def __init__(self, points=(), quads=()):
        self.mesh = bmesh.new()
        for name in "uv":
            self.mesh.verts.layers.float.new(name)
        self.take_layers()
        self.textured = False
        self.add(points, quads)

    def take_layers(self):
        self.creases = self.mesh.edges.layers.crease.verify()
        self.places = [self.mesh.verts.layers.float[name] for name in "uv"]

    def add(self, points, quads):
        vertices = [self.mesh.verts.new(p) for p in points]
        for quad in quads:
            self.mesh.faces.new([vertices[i] for i in quad])
        return vertices

    def crease(self, sharpness=HARD, edges=None, where=None):
        """Makes edges sharp: those given, or those whose both ends `where` accepts; all of them without either."""
        for edge in self.mesh.edges if edges is None else edges:
            if where is None or all(where(v.co) for v in edge.verts):
                edge[self.creases] = math.sqrt(sharpness / 10)  # Blender's own scale, so that its subdivision agrees
        return self

    def crease_angle(self, degrees, sharpness=HARD):
        """Makes sharp the edges at which the cage bends by more than `degrees`."""
        self.mesh.normal_update()
        bent = [e for e in self.mesh.edges if len(e.link_faces) == 2 and math.degrees(e.calc_face_angle()) > degrees]
        return self.crease(sharpness, bent)

    def texture(self, place):
        """Texture coordinates: `place` maps a point (Vector) to (u, v)."""
        self.texture_points(self.mesh.verts, [place(vertex.co) for vertex in self.mesh.verts])
        return self

    def bend(self, function):
        """Moves every point p (Vector) to function(p)."""
        for vertex in self.mesh.verts:
            vertex.co = Vector(function(vertex.co.copy()))
        return self

    def move(self, x, y, z):
        return self.transform(Matrix.Translation((x, y, z)))

    def turn(self, axis, degrees):
        """Turns about 'X', 'Y' or 'Z' through the origin."""
        return self.transform(Matrix.Rotation(math.radians(degrees), 4, axis))

    def scale(self, x, y, z):
        return self.transform(Matrix.Diagonal((x, y, z, 1)))

    def transform(self, matrix):
        self.mesh.transform(matrix)
        if matrix.determinant() < 0:
            self.flip()
        return self

    def flip(self):
        bmesh.ops.reverse_faces(self.mesh, faces=self.mesh.faces[:])
        return self

    def mirrored(self):
        """A copy, mirrored at x = 0."""
        return self.copy().scale(-1, 1, 1)

    def copy(self):
        other = Cage()
        other.mesh = self.mesh.copy()
        other.take_layers()
        other.textured = self.textured
        return other

    def join(self, *others):
        """Takes in copies of other cages; neither is joined to the other at its points."""
        for other in others:
            points = [v.co.copy() for v in other.mesh.verts]
            other.mesh.verts.index_update()
            quads = [[v.index for v in f.verts] for f in other.mesh.faces]
            sharp = [(e.verts[0].index, e.verts[1].index, e[other.creases]) for e in other.mesh.edges if e[other.creases] > 0]
            places = None
            if other.textured:
                u, v = other.places
                places = [(p[u], p[v]) for p in other.mesh.verts]
            vertices = self.add(points, quads)
            for a, b, sharpness in sharp:
                edge = self.mesh.edges.get((vertices[a], vertices[b]))
                edge[self.creases] = sharpness
            if places:
                self.texture_points(vertices, places)
        return self

    def texture_points(self, vertices, places):
        for vertex, place in zip(vertices, places):
            vertex[self.places[0]], vertex[self.places[1]] = place
        self.textured = True

    def weld(self, distance=1e-5):
        """Joins points closer than `distance`."""
        bmesh.ops.remove_doubles(self.mesh, verts=self.mesh.verts[:], dist=distance)
        return self

    def outward(self):
        """Turns the faces of closed cages outward."""
        bmesh.ops.recalc_face_normals(self.mesh, faces=self.mesh.faces[:])
        return self

    def diameter(self):
        low, high = ([side(v.co[k] for v in self.mesh.verts) for k in range(3)] for side in (min, max))
        return (Vector(high) - Vector(low)).length


def box(x, y, z, sharpness=HARD):
    """A box about the origin with the given sizes; a sharpness of 2 to 4 rounds its edges."""
    corners = [(sx * x / 2, sy * y / 2, sz * z / 2) for sx in (-1, 1) for sy in (-1, 1) for sz in (-1, 1)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return Cage(corners, quads).crease(sharpness)


def grid(rows, closed_rows=False, closed_columns=False):
    """A sheet through rows of points, rows[i][j]; its front is where i x j points: (next row) x (next column).
    Closed: the last row (or column) goes on to the first."""
    n, m = len(rows), len(rows[0])
    quads = []
    for i in range(n if closed_rows else n - 1):
        for j in range(m if closed_columns else m - 1):
            k, l = (i + 1) % n, (j + 1) % m
            quads.append((i * m + j, k * m + j, k * m + l, i * m + l))
    return Cage([p for row in rows for p in row], quads)


def lathe(profile, segments, closed=False):
    """Turns a profile of (radius, x) about the x axis. The front is to the left of the profile's direction, seen with
    x to the right and the radius up: a profile from high x to low x looks outward. Closed: it ends where it began."""
    rows = []
    for i in range(segments):
        angle = 2 * math.pi * i / segments
        rows.append([(x, r * math.cos(angle), r * math.sin(angle)) for r, x in profile])
    return grid(rows, closed_rows=True, closed_columns=closed)


def cap(cage, loop):
    """Closes an even ring of points (BMVerts in order) by a strip of quads."""
    n = len(loop)
    for i in range(n // 2 - 1):
        cage.mesh.faces.new([loop[i], loop[i + 1], loop[n - 2 - i], loop[n - 1 - i]])
    return cage


def close_ends(cage):
    """Caps every open ring of an even number of points, with hard edges, and turns the faces outward."""
    following = {}
    for edge in cage.mesh.edges:
        if len(edge.link_faces) == 1:
            loop = edge.link_loops[0]
            following[loop.link_loop_next.vert] = loop.vert  # the other way round than its face
            edge[cage.creases] = 1
    while following:
        ring = [next(iter(following))]
        while (vertex := following.pop(ring[-1])) is not ring[0]:
            ring.append(vertex)
        cap(cage, ring)
    return cage.outward()


def cylinder(radius, length, segments=8, sharpness=HARD):
    """A closed cylinder about the x axis through the origin; its rims have the given sharpness."""
    cage = lathe([(radius, length / 2), (radius, -length / 2)], segments)
    vertices = list(cage.mesh.verts)
    cage.crease(sharpness, where=lambda p: p.x > 0)
    cage.crease(sharpness, where=lambda p: p.x < 0)
    cap(cage, vertices[0::2])
    cap(cage, vertices[1::2])
    return cage.outward()


def tube(path, radius, segments=6, capped=True, up=(0, 1, 0)):
    """A round tube along a path of points; radius is a number or one for each point."""
    path = [Vector(p) for p in path]
    radii = radius if isinstance(radius, (list, tuple)) else [radius] * len(path)
    rows, across = [], None
    for i, p in enumerate(path):
        along = (path[min(i + 1, len(path) - 1)] - path[max(i - 1, 0)]).normalized()
        if across is None:
            across = along.cross(Vector(up))
            if across.length < 0.1:
                across = along.cross(Vector((1, 0, 0)))
        across = (across - along * across.dot(along)).normalized()
        other = along.cross(across)
        rows.append([p + radii[i] * (math.cos(a) * across + math.sin(a) * other)
                     for a in (2 * math.pi * k / segments for k in range(segments))])
    cage = grid(rows, closed_columns=True)
    if capped:
        vertices = list(cage.mesh.verts)
        for ring in (vertices[:segments], vertices[-segments:]):
            cap(cage, ring)
            for a, b in zip(ring, ring[1:] + ring[:1]):
                cage.mesh.edges.get((a, b))[cage.creases] = 1
    return cage.outward()


def thickened(cage, depth):
    """Makes a sheet a closed solid: its own face in front, another `depth` behind it, a hard rim between."""
    mesh = cage.mesh
    mesh.normal_update()
    front = list(mesh.verts)
    faces = list(mesh.faces)
    rim = [(e.verts[0], e.verts[1], e.link_faces[0]) for e in mesh.edges if len(e.link_faces) == 1]
    sharp = [(e.verts[0], e.verts[1], e[cage.creases]) for e in mesh.edges]
    back = {v: mesh.verts.new(v.co - v.normal * depth) for v in front}
    for face in faces:
        mesh.faces.new([back[v] for v in reversed(face.verts)])
    for a, b, sharpness in sharp:
        mesh.edges.get((back[a], back[b]))[cage.creases] = sharpness
    for a, b, face in rim:
        order = list(face.verts)
        first, second = (a, b) if order[(order.index(a) + 1) % len(order)] == b else (b, a)
        mesh.faces.new([second, first, back[first], back[second]])
        for edge in ((a, b), (back[a], back[b])):
            mesh.edges.get(edge)[cage.creases] = 1
    return cage


class Car:
    """The tree of nodes, the meshes, materials and skins. Names and numbers are what scripts and logs use: every module
    numbers its nodes from a number of its own (`numbered_from`), so that a new part leaves the others' ids alone."""

    def __init__(self, name):
        self.materials, self.meshes, self.skins = [], [], []
        self.nodes = [{"id": 0, "name": name, "type": "root"}]
        self.next_id = 1

    def numbered_from(self, first):
        self.next_id = first

    def material(self, name, **members):
        self.materials.append({"name": name, **members})

    def node(self, type_, name, parent=0, matrix=None, **members):
        node = {"id": self.next_id, "name": name, "type": type_, "parent": parent, **members}
        if any(n["id"] == self.next_id for n in self.nodes):
            raise ValueError(f"two nodes have the id {self.next_id}: {name}")
        if matrix is not None:
            node["matrix"] = [round(x, 7) for row in matrix for x in row]
        self.next_id += 1
        self.nodes.append(node)
        return node["id"]

    def group(self, name, parent=0, matrix=None, **members):
        """`hinge`, x y z degrees, where it opens by turning about an axis through its own origin."""
        return self.node("assembly", name, parent, matrix, **members)

    def mesh(self, cage, name):
        """Takes a cage in; its number, for several nodes to use."""
        self.meshes.append((name, cage))
        return len(self.meshes) - 1

    def part(self, name, parent, cage, material, matrix=None, tolerance=1.0, detail=None):
        """A node with geometry: of a cage, or of a mesh's number. `tolerance` is a factor on the permitted error;
        a part with `detail` is left out of a car of fewer triangles: unless told otherwise, FINE for small ones, and for those on which little depends."""
        mesh = cage if isinstance(cage, int) else self.mesh(cage, name)
        more = {} if tolerance == 1 else {"tolerance": tolerance}
        if detail is None:
            detail = FINE if self.meshes[mesh][1].diameter() < SMALL or tolerance >= 2 else 0
        if detail:
            more["detail"] = detail
        return self.node("geometry", name, parent, matrix, mesh=mesh, material=material, **more)

    def skin(self, cage, name):
        self.skins.append({"mesh": self.mesh(cage, name), "cuts": []})
        return len(self.skins) - 1

    def cut(self, skin, name, *within, gap=0.0045, detail=0):
        """Adds a cut: outlines as (from, [(a, b, radius), ...]). In a car of fewer triangles than `detail` it is not
        made: what it would take goes to its neighbours."""
        more = {"detail": detail} if detail else {}
        self.skins[skin]["cuts"].append({"name": name, "gap": gap, **more,
                                         "within": [{"from": side, "outline": outline} for side, outline in within]})

    def panel(self, name, parent, skin, cut, material, lift=0.0, thickness=0.02, edge=0.002, layer=None, grow=0, detail=0):
        """A cut's piece of a skin as a closed shell, or of that the "outside" (sheet and rounded edge), the "inside" (rim
        and back) or the "back". It may `grow` under what surrounds it."""
        panel = {"skin": skin, "cut": cut, "lift": lift, "thickness": thickness, "edge": edge}
        panel.update({key: value for key, value in (("layer", layer), ("grow", grow)) if value})
        more = {"detail": detail} if detail else {}
        return self.node("geometry", name, parent, None, material=material, tolerance=0.3, panel=panel, **more)

    def painted_panel(self, name, parent, skin, cut, thickness=0.02):
        """Sheet metal: painted outside; the edges' depth and the back are dark, as nothing shades them."""
        switch = self.painted(name, parent, lambda child, above, paint: self.panel(
            child, above, skin, cut, paint, thickness=thickness, layer="outside"))
        self.panel(f"{name} liner", parent, skin, cut, "Black trim", thickness=thickness, layer="inside", detail=FINE)
        return switch

    def pane(self, name, parent, skin, cut, material, lift=-0.004, thickness=0.004):
        """Glass: two sheets, each drawn from its own side, which renderers sort with less work than a closed shell. Its
        border lies in the frame."""
        panel = {"lift": lift, "thickness": thickness, "edge": 0, "grow": 0.006}
        self.panel(f"{name} inside", parent, skin, cut, material, **panel, layer="back")
        return self.panel(name, parent, skin, cut, material, **panel, layer="outside")

    PAINTS = ("Red", "Silver", "Green")

    def painted(self, name, parent, make):
        """A part in the three paints: a switch with one child for each, all of one geometry.
        `make(child name, parent, material)` makes the first child."""
        switch = self.node("switch", name, parent, activeChild=0)
        first = make(self.PAINTS[0], switch, f"Paint {self.PAINTS[0].lower()}")
        for paint in self.PAINTS[1:]:
            self.node("geometry", paint, switch, geometryOf=first, material=f"Paint {paint.lower()}")
        return switch

    def text(self):
        """car.json: one line for each mesh, cut and node, so that a change shows as one."""
        meshes = [json.dumps(mesh_description(name, cage), separators=(",", ":")) for name, cage in self.meshes]
        skins = [json.dumps(s, separators=(",", ":")) for s in self.skins]
        nodes = [json.dumps(n, separators=(",", ":"), ensure_ascii=False) for n in self.nodes]
        materials = [json.dumps(m, separators=(",", ":")) for m in self.materials]
        blocks = [f'"{key}":[\n' + ",\n".join(lines) + "\n]"
                  for key, lines in (("materials", materials), ("meshes", meshes), ("skins", skins), ("nodes", nodes))]
        return '{"unit":' + repr(UNIT) + ",\n" + ",\n".join(blocks) + "}\n"


def mesh_description(name, cage):
    mesh = cage.mesh
    mesh.verts.index_update()
    for face in mesh.faces:
        if len(face.verts) != 4:
            raise ValueError(f"{name}: a face has {len(face.verts)} corners, quads only")
    for edge in mesh.edges:
        if len(edge.link_faces) > 2:
            raise ValueError(f"{name}: three faces meet at an edge at {tuple(edge.verts[0].co)}")
    quads = [[v.index for v in face.verts] for face in mesh.faces]
    used = sorted({i for quad in quads for i in quad})
    number = {old: new for new, old in enumerate(used)}
    mesh.verts.ensure_lookup_table()
    description = {"name": name,
                   "points": [[round(c / UNIT) for c in mesh.verts[i].co] for i in used],
                   "quads": [[number[i] for i in quad] for quad in quads]}
    if cage.textured:
        u, v = cage.places
        description["texcoords"] = [[round(mesh.verts[i][u], 4), round(mesh.verts[i][v], 4)] for i in used]
    creases = [[number[e.verts[0].index], number[e.verts[1].index], round(10 * e[cage.creases] ** 2, 2)]
               for e in mesh.edges if e[cage.creases] > 0 and e.link_faces]
    if creases:
        description["creases"] = creases
    return description
