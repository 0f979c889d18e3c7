"""A reader of ISO 10303-21 and of the solids that tubecut writes in it: grammar, references, geometry. It knows the standard, not our writer."""

import re

import numpy as np

TOKEN = re.compile(r"""\s*(?:(?P<string>'(?:[^'\\]|''|\\\\|\\X2\\(?:[0-9A-F]{4})+\\X0\\|\\X4\\(?:[0-9A-F]{8})+\\X0\\)*')
  |(?P<real>[+-]?\d+\.\d*(?:E[+-]?\d+)?)|(?P<integer>[+-]?\d+)|(?P<name>\#\d+)|(?P<enumeration>\.[A-Z_][A-Z0-9_]*\.)
  |(?P<word>!?[A-Z_][A-Z0-9_]*)|(?P<sign>[()=;,$*]))""", re.X)
FOREIGN = re.compile(r"[^ -~\n]")
# Most of a file is points, so they are read at once; they are of the grammar that `value` reads token by token.
REAL = r"[+-]?\d+\.\d*(?:E[+-]?\d+)?"
POINT = re.compile(rf"#(\d+)=CARTESIAN_POINT\('',\(({REAL}(?:,{REAL})*)\)\);\n")


class Malformed(Exception):
    pass


class Name(int):
    """Of an entity."""


class Word(str):
    """An enumeration's value."""


def text_of(literal):
    inner = literal[1:-1]
    if any(not " " <= c <= "~" for c in inner):
        raise Malformed(f"a string beyond ASCII: {literal!r}")

    def wide(match):
        if match[1] is not None:
            return bytes.fromhex(match[1]).decode("utf-16-be")
        if match[2] is not None:
            return bytes.fromhex(match[2]).decode("utf-32-be")
        return match[0][0]
    return re.sub(r"\\X2\\((?:[0-9A-F]{4})+)\\X0\\|\\X4\\((?:[0-9A-F]{8})+)\\X0\\|''|\\\\", wide, inner)


def tokens(text):
    at, out = 0, []
    for match in TOKEN.finditer(text):
        if match.start() != at:
            break
        kind, at = match.lastgroup, match.end()
        out.append((kind, match[kind]))
    if text[at:].strip():
        raise Malformed(f"no token: {text[at:at + 60]!r}")
    return out


def value(stream, i):
    kind, word = stream[i]
    if kind == "string":
        return text_of(word), i + 1
    if kind == "real":
        return float(word), i + 1
    if kind == "integer":
        return int(word), i + 1
    if kind == "name":
        return Name(word[1:]), i + 1
    if kind == "enumeration":
        return Word(word), i + 1
    if word in "$*":
        return None, i + 1
    if word == "(":
        return values(stream, i)
    if kind == "word" and stream[i + 1][1] == "(":  # a value with its type
        inner, i = values(stream, i + 1)
        return (word, inner), i
    raise Malformed(f"no value: {word}")


def values(stream, i):
    """The list that begins at i, and where it ends."""
    if stream[i][1] != "(":
        raise Malformed("a list was expected")
    out, i = [], i + 1
    while stream[i][1] != ")":
        one, i = value(stream, i)
        out.append(one)
        if stream[i][1] == ",":
            i += 1
            if stream[i][1] == ")":
                raise Malformed("a comma before a bracket")
        elif stream[i][1] != ")":
            raise Malformed("no comma between two values")
    return out, i + 1


class File:
    """header: {word: values}; entities: {number: (type, values)}, of a complex one ({type: values})."""

    def __init__(self, text):
        if FOREIGN.search(text):
            raise Malformed("a character that the standard does not know")
        shape = re.fullmatch(r"ISO-10303-21;\nHEADER;\n(.*?)ENDSEC;\nDATA;\n(.*)ENDSEC;\nEND-ISO-10303-21;\n", text, re.S)
        if not shape:
            raise Malformed("not the frame of an exchange structure")
        self.header, stream, i = {}, tokens(shape[1]), 0
        while i < len(stream):
            word = stream[i][1]
            self.header[word], i = values(stream, i + 1)
            i = self.end(stream, i)
        if list(self.header) != ["FILE_DESCRIPTION", "FILE_NAME", "FILE_SCHEMA"]:
            raise Malformed(f"header of {list(self.header)}")
        if any(len(line) > 256 for line in self.header["FILE_DESCRIPTION"][0]):
            raise Malformed("a line of the header is longer than 256")
        self.entities = {}
        for number, coordinates in POINT.findall(shape[2]):
            self.add(int(number), ("CARTESIAN_POINT", ["", [float(word) for word in coordinates.split(",")]]))
        stream, i = tokens(POINT.sub("", shape[2])), 0
        while i < len(stream):
            if stream[i][0] != "name" or stream[i + 1][1] != "=":
                raise Malformed(f"no instance: {stream[i]}")
            number, i = int(stream[i][1][1:]), i + 2
            if stream[i][1] == "(":
                parts, i = {}, i + 1
                while stream[i][1] != ")":
                    word = stream[i][1]
                    parts[word], i = values(stream, i + 1)
                if list(parts) != sorted(parts):
                    raise Malformed("the parts of a complex instance are not in the order of the alphabet")
                self.add(number, parts)
                i += 1
            else:
                word = stream[i][1]
                inner, i = values(stream, i + 1)
                self.add(number, (word, inner))
            i = self.end(stream, i)
        self.check_references()

    def add(self, number, entity):
        if number in self.entities:
            raise Malformed(f"#{number} twice")
        self.entities[number] = entity

    @staticmethod
    def end(stream, i):
        if stream[i][1] != ";":
            raise Malformed("no semicolon")
        return i + 1

    def check_references(self):
        used = set()

        def see(item):
            if isinstance(item, Name):
                used.add(int(item))
            elif isinstance(item, (list, tuple)):
                for one in item:
                    see(one)
            elif isinstance(item, dict):
                see(list(item.values()))
        for entity in self.entities.values():
            if isinstance(entity, dict) or entity[0] != "CARTESIAN_POINT":
                see(entity)
        if used - set(self.entities):
            raise Malformed(f"named and not there: {sorted(used - set(self.entities))[:5]}")
        roots = {self.entities[n][0] for n in set(self.entities) - used if not isinstance(self.entities[n], dict)}
        if roots - {"APPLICATION_PROTOCOL_DEFINITION", "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", "PRODUCT_RELATED_PRODUCT_CATEGORY", "SHAPE_DEFINITION_REPRESENTATION",
                    "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION"}:
            raise Malformed(f"used by nobody: {roots}")

    def of(self, kind):
        return [n for n, entity in self.entities.items() if not isinstance(entity, dict) and entity[0] == kind]

    def get(self, number, *kinds):
        entity = self.entities[number]
        if isinstance(entity, dict) or entity[0] not in kinds:
            raise Malformed(f"#{number} is {entity if isinstance(entity, dict) else entity[0]}, not {kinds}")
        return entity[1]


class Spline:
    """Curve or surface of which one direction is a B-spline of any degree: rows of points, spans between its knots."""

    def __init__(self, degree, points, counts, knots):
        self.degree, self.points = degree, points
        if sum(counts) != len(points) + degree + 1 or len(counts) != len(knots):
            raise Malformed("knots and points do not go together")
        if any(b <= a for a, b in zip(knots, knots[1:])) or counts[0] != degree + 1 or counts[-1] != degree + 1:
            raise Malformed("knots do not rise, or the ends are open")
        if any(not 1 <= count <= degree for count in counts[1:-1]):
            raise Malformed("a knot of too high a multiplicity")
        self.knots, self.flat, self.sampled = np.array(knots), np.repeat(knots, counts), None

    def at(self, u):
        """(points, slopes) at each u, by de Boor."""
        p, flat = self.degree, self.flat
        span = np.clip(np.searchsorted(flat, u, side="right") - 1, p, len(self.points) - 1)
        d = [self.points[span - p + j] for j in range(p + 1)]
        slope = None
        for r in range(1, p + 1):
            if r == p:
                wide = (flat[span + 1] - flat[span]).reshape((-1,) + (1,) * (d[0].ndim - 1))
                slope = p * (d[p] - d[p - 1]) / wide
            new = list(d)
            for j in range(p, r - 1, -1):
                low, high = flat[span - p + j], flat[span + 1 + j - r]
                share = ((u - low) / (high - low)).reshape((-1,) + (1,) * (d[0].ndim - 1))
                new[j] = (1 - share) * d[j - 1] + share * d[j]
            d = new
        return d[p], slope

    def rulings(self):
        """Of a ruled surface, once for all points that are held against it."""
        if self.sampled is None:
            self.sampled = Rulings(self)
        return self.sampled

    def within(self, places):
        """Parameters at these shares of every span."""
        wide = np.diff(self.knots)
        return (self.knots[:-1, None] + wide[:, None] * np.asarray(places)[None, :]).ravel()


def axes(file, number):
    """Origin and rows (x, y, z) of a placement."""
    _, at, z, x = file.get(number, "AXIS2_PLACEMENT_3D")
    point, up, along = (np.array(file.get(n, kind)[1]) for n, kind in ((at, "CARTESIAN_POINT"), (z, "DIRECTION"), (x, "DIRECTION")))
    return point, np.array([along, np.cross(up, along), up])


def assembly(file):
    """[(name of the use, its part's product, the brep, origin, rows)] of the file's one assembly, as its own entities tie them together."""
    def product(definition):
        formation = file.get(definition, "PRODUCT_DEFINITION")[2]
        return file.get(file.get(formation, "PRODUCT_DEFINITION_FORMATION")[2], "PRODUCT")[0]
    shape_of = {}
    for number in file.of("SHAPE_DEFINITION_REPRESENTATION"):
        shape, representation = file.get(number, "SHAPE_DEFINITION_REPRESENTATION")
        shape_of[int(file.get(shape, "PRODUCT_DEFINITION_SHAPE")[2])] = int(representation)
    out, wholes = [], set()
    for number in file.of("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION"):
        how, there = file.get(number, "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION")
        use = file.get(file.get(there, "PRODUCT_DEFINITION_SHAPE")[2], "NEXT_ASSEMBLY_USAGE_OCCURRENCE")
        relation = file.entities[how]
        part, whole = relation["REPRESENTATION_RELATIONSHIP"][2:]
        wholes.add(int(use[3]))
        if shape_of[int(use[4])] != part or shape_of[int(use[3])] != whole:
            raise Malformed("a use whose shapes are not its products'")
        moved = relation["REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION"][0]
        own, place = file.get(moved, "ITEM_DEFINED_TRANSFORMATION")[2:]
        own_axes, brep = file.get(part, "ADVANCED_BREP_SHAPE_REPRESENTATION")[1]
        if own != own_axes or place not in file.get(whole, "SHAPE_REPRESENTATION")[1]:
            raise Malformed("a move that is of neither shape")
        if not np.array_equal(axes(file, own)[1], np.eye(3)) or np.any(axes(file, own)[0]):
            raise Malformed("a part that is not in its own frame")
        out.append((use[1], product(use[4]), int(brep), *axes(file, place)))
    if len(wholes) != 1:
        raise Malformed(f"{len(wholes)} assemblies")
    return out


class Solid:
    """A closed shell of a file, the only one unless it is named: vertices, edges, faces, each with its geometry."""

    def __init__(self, file, brep=None):
        self.file = file
        units = [e["SI_UNIT"] for e in file.entities.values() if isinstance(e, dict) and "LENGTH_UNIT" in e]
        if units != [[".MILLI.", ".METRE."]]:
            raise Malformed(f"lengths in {units}")
        shells = file.of("CLOSED_SHELL")
        breps = file.of("MANIFOLD_SOLID_BREP")
        if len(shells) != len(breps) or brep is None and len(breps) != 1:
            raise Malformed("not one solid of one shell")
        shell = file.get(brep or breps[0], "MANIFOLD_SOLID_BREP")[1]
        self.edges, self.faces = {}, []
        for number in file.get(shell, "CLOSED_SHELL")[1]:
            name, bounds, surface, same = file.get(number, "ADVANCED_FACE")
            loops = []
            for i, bound in enumerate(bounds):
                kinds = ("FACE_OUTER_BOUND",) if i == 0 else ("FACE_BOUND",)
                _, loop, forward = file.get(bound, *kinds)
                if forward != ".T.":
                    raise Malformed("a bound against its loop")
                loops.append([self.use(oriented) for oriented in file.get(loop, "EDGE_LOOP")[1]])
            self.faces.append({"name": name, "loops": loops, "surface": self.surface(surface), "number": int(surface), "same": same == ".T."})

    def use(self, oriented):
        _, first, last, edge, forward = self.file.get(oriented, "ORIENTED_EDGE")
        if first is not None or last is not None:
            raise Malformed("an oriented edge with vertices of its own")
        if edge not in self.edges:
            _, start, end, curve, same = self.file.get(edge, "EDGE_CURVE")
            if same != ".T.":
                raise Malformed("an edge against its curve")
            curve, flats = self.curve_and_flats(curve)
            self.edges[edge] = {"ends": (int(start), int(end)), "points": (self.vertex(start), self.vertex(end)), "curve": curve, "flats": flats}
        return int(edge), forward == ".T."

    def triple(self, number, kind):
        out = np.array(self.file.get(number, kind)[1])
        if out.shape != (3,):
            raise Malformed("not three numbers")
        return out

    def vertex(self, number):
        return self.triple(self.file.get(number, "VERTEX_POINT")[1], "CARTESIAN_POINT")

    def frame(self, number):
        _, origin, z, x = self.file.get(number, "AXIS2_PLACEMENT_3D")
        x = self.triple(x, "DIRECTION")
        if not (np.array_equal(self.triple(z, "DIRECTION"), (0, 0, 1)) and x[2] == 0.0 and abs(np.linalg.norm(x) - 1) < 1e-11):
            raise Malformed("a frame that is not about z")
        return self.triple(origin, "CARTESIAN_POINT")

    def axes(self, number):
        """Origin, z and x of a frame of any direction."""
        _, origin, z, x = self.file.get(number, "AXIS2_PLACEMENT_3D")
        z, x = self.triple(z, "DIRECTION"), self.triple(x, "DIRECTION")
        if max(abs(z @ z - 1), abs(x @ x - 1), abs(x @ z)) > 1e-9:
            raise Malformed("a frame that is not square")
        return self.triple(origin, "CARTESIAN_POINT"), z, x

    def about_z(self, number):
        z = self.triple(self.file.get(number, "AXIS2_PLACEMENT_3D")[2], "DIRECTION")
        return np.array_equal(z, (0, 0, 1))

    def plane(self, number):
        """Point and normal of a plane; x of its frame lies in it."""
        _, origin, z, x = self.file.get(number, "AXIS2_PLACEMENT_3D")
        normal, x = self.triple(z, "DIRECTION"), self.triple(x, "DIRECTION")
        if abs(np.linalg.norm(normal) - 1) > 1e-9 or abs(np.linalg.norm(x) - 1) > 1e-9 or abs(x @ normal) > 1e-9:
            raise Malformed("a frame that is not square")
        return self.triple(origin, "CARTESIAN_POINT"), normal

    def curve_and_flats(self, number):
        """A curve, and what it is on surfaces: [(cylinder's number, where (angle, height) is on it, spline)]."""
        if self.file.entities[number][0] != "SURFACE_CURVE":
            return self.curve(number), []
        _, curve, held, which = self.file.get(number, "SURFACE_CURVE")
        if which != ".CURVE_3D.":
            raise Malformed("a curve that is not first of all in space")
        flats = []
        for pcurve in held:
            _, surface, definition = self.file.get(pcurve, "PCURVE")
            (line,), context = self.file.get(definition, "DEFINITIONAL_REPRESENTATION")[1:]
            if self.file.entities[context].keys() != {"GEOMETRIC_REPRESENTATION_CONTEXT", "PARAMETRIC_REPRESENTATION_CONTEXT", "REPRESENTATION_CONTEXT"} or \
                    self.file.entities[context]["GEOMETRIC_REPRESENTATION_CONTEXT"] != [2]:
                raise Malformed("a curve of two parameters elsewhere")
            _, degree, points, _, _, _, counts, knots, _ = self.file.get(line, "B_SPLINE_CURVE_WITH_KNOTS")
            at = Spline(degree, np.array([self.file.get(n, "CARTESIAN_POINT")[1] for n in points]), counts, knots)
            flats.append((int(surface), self.place(surface), at))
        return self.curve(curve), flats

    def place(self, cylinder):
        """Points at (angle, height) of a cylinder; none beyond a turn."""
        _, frame, radius = self.file.get(cylinder, "CYLINDRICAL_SURFACE")
        if np.any(self.frame(frame)):
            raise Malformed("a cylinder that begins elsewhere")
        x = self.triple(self.file.get(frame, "AXIS2_PLACEMENT_3D")[3], "DIRECTION")
        begins = np.arctan2(x[1], x[0])

        def on(at):
            beyond = (at[:, :1] < 0) | (at[:, :1] > 2 * np.pi)
            turn = begins + at[:, 0]
            return np.where(beyond, np.inf, np.stack([radius * np.cos(turn), radius * np.sin(turn), at[:, 1]], axis=1))
        return on

    def curve(self, number):
        kind, v = self.file.entities[number]
        if kind == "LINE":
            _, direction, length = self.file.get(v[2], "VECTOR")
            return ("line", self.triple(v[1], "CARTESIAN_POINT"), length * self.triple(direction, "DIRECTION"))
        if kind == "CIRCLE":
            return ("circle", self.frame(v[1]), v[2]) if self.about_z(v[1]) else ("arc", *self.axes(v[1]), v[2])
        if kind != "B_SPLINE_CURVE_WITH_KNOTS":
            raise Malformed(f"a curve {kind}")
        points = np.array([self.triple(n, "CARTESIAN_POINT") for n in v[2]])
        return ("spline", Spline(v[1], points, v[6], v[7]))

    def surface(self, number):
        kind, v = self.file.entities[number]
        if kind == "CYLINDRICAL_SURFACE":
            return ("cylinder", self.frame(v[1]), v[2]) if self.about_z(v[1]) else ("bore", *self.axes(v[1]), v[2])
        if kind == "CONICAL_SURFACE":
            return ("cone", *self.axes(v[1]), v[2], v[3])
        if kind == "PLANE":
            return ("plane", *self.plane(v[1]))
        if kind != "B_SPLINE_SURFACE_WITH_KNOTS" or v[2] != 1 or v[9] != [2, 2]:
            raise Malformed(f"a surface {kind}")
        grid = np.array([[self.triple(n, "CARTESIAN_POINT") for n in row] for row in v[3]])
        return ("ruled", Spline(v[1], grid, v[8], v[10]))


PLACES, WEIGHTS = np.polynomial.legendre.leggauss(6)
PLACES, WEIGHTS = (PLACES + 1) / 2, WEIGHTS / 2
NEAR = 1e-3  # mm: an edge on both its faces
STILL = 1e-10  # of a surface, what a step to the nearest place is to be more than
FLAT_OFF = NEAR  # mm: distance of an edge from its curve on the cylinder at the same parameter


def arc_of(edge):
    """Origin, axis, x, y, radius of an arc about any axis, and its angles, ascending."""
    origin, z, x, radius = edge["curve"][1:]
    y = np.cross(z, x)
    first, last = (np.arctan2((p - origin) @ y, (p - origin) @ x) for p in edge["points"])
    return origin, z, x, y, radius, first, last if last > first + 1e-9 else last + 2 * np.pi


def curve_points(edge, forward=True):
    """Points along an edge, ends included, in its direction."""
    kind, *about = edge["curve"]
    a, b = edge["points"]
    if kind == "spline":
        out = about[0].at(np.unique(np.append(about[0].within((0, 0.25, 0.5, 0.75)), about[0].knots[-1])))[0]
    elif kind == "line":
        out = a + np.linspace(0, 1, 5)[:, None] * (b - a)
    elif kind == "arc":
        origin, _, x, y, radius, first, last = arc_of(edge)
        turn = np.linspace(first, last, 33)[:, None]
        out = origin + radius * (np.cos(turn) * x + np.sin(turn) * y)
    else:
        origin, radius = about
        first, last = (np.arctan2(*(p - origin)[1::-1]) for p in (a, b))
        turn = np.linspace(first, last if last > first + 1e-9 else last + 2 * np.pi, 33)
        out = origin + np.stack([radius * np.cos(turn), radius * np.sin(turn), 0 * turn], axis=1)
    return out if forward else out[::-1]


BLOCK = 32  # rulings


class Rulings:
    """Rulings of a surface, eight to a span, in blocks of which each has its ball."""

    def __init__(self, spline):
        u = spline.within(np.arange(8) / 8)
        u = np.append(u, np.repeat(u[-1], -len(u) % BLOCK)).reshape(-1, BLOCK)
        ends = spline.at(u.ravel())[0].reshape(*u.shape, 2, 3)
        self.u, self.foot, self.across = u, ends[:, :, 0], ends[:, :, 1] - ends[:, :, 0]
        self.square = np.einsum("bki,bki->bk", self.across, self.across)
        corners = ends.reshape(len(u), -1, 3)
        self.centre = (corners.min(axis=1) + corners.max(axis=1)) / 2
        self.radius = np.linalg.norm(corners - self.centre[:, None], axis=2).max(axis=1)

    def nearest(self, points):
        """(u, v) of the nearest place on any of them. Only those blocks are looked at whose ball may hold it."""
        if len(points) > 256:  # what is held at a time
            return np.concatenate([self.nearest(points[i:i + 256]) for i in range(0, len(points), 256)], axis=1)
        far = np.linalg.norm(points[:, None] - self.centre[None], axis=2)
        which, block = np.nonzero(far - self.radius <= (far + self.radius).min(axis=1)[:, None])
        way = points[which, None] - self.foot[block]
        v = np.clip(np.einsum("nki,nki->nk", way, self.across[block]) / self.square[block], 0, 1)
        off = np.linalg.norm(way - v[:, :, None] * self.across[block], axis=2)
        each, best = np.arange(len(which)), np.argmin(off, axis=1)
        first = np.lexsort((off[each, best], which))[np.flatnonzero(np.diff(which, prepend=-1))]
        return np.stack([self.u[block[first], best[first]], v[first, best[first]]])


def nearest(spline, points):
    """Distance of each point to a ruled surface, within its border."""
    def seen(u, v):
        p, d = spline.at(u)
        v = v[:, None]
        return (1 - v) * p[:, 0] + v * p[:, 1], (1 - v) * d[:, 0] + v * d[:, 1], p[:, 1] - p[:, 0]
    u, v = spline.rulings().nearest(points)
    out = np.full(len(points), np.inf)
    for _ in range(8):
        place, du, dv = seen(u, v)
        miss = points - place
        out = np.minimum(out, np.linalg.norm(miss, axis=1))
        a, b, c = (np.einsum("pi,pi->p", x, y) for x, y in ((du, du), (du, dv), (dv, dv)))
        e, f = (np.einsum("pi,pi->p", x, miss) for x in (du, dv))
        det = a * c - b * b
        det = np.where(det > 1e-30, det, np.inf)
        next_u = np.clip(u + (c * e - b * f) / det, spline.knots[0], spline.knots[-1])
        next_v = np.clip(v + (a * f - b * e) / det, 0, 1)
        if np.allclose(next_u, u, rtol=0, atol=STILL * np.ptp(spline.knots)) and np.allclose(next_v, v, rtol=0, atol=STILL):
            break
        u, v = next_u, next_v
    return out


def off_surface(surface, points):
    kind, *about = surface
    if kind == "cylinder":
        from_axis = points - about[0]
        return np.abs(np.hypot(from_axis[:, 0], from_axis[:, 1]) - about[1])
    if kind == "plane":
        return np.abs((points - about[0]) @ about[1])
    if kind == "bore":
        origin, axis, _, radius = about
        return np.abs(np.linalg.norm(np.cross(points - origin, axis), axis=1) - radius)
    if kind == "cone":
        origin, axis, _, radius, half = about
        height = (points - origin) @ axis
        from_axis = np.linalg.norm(np.cross(points - origin, axis), axis=1)
        return np.abs(from_axis - radius - height * np.tan(half)) * np.cos(half)
    return nearest(about[0], points)


def off_flat(edge, flat):
    """A curve from what it is on a cylinder, at the same parameters, mm."""
    _, place, spline = flat
    whole = edge["curve"][1]
    if not np.array_equal(spline.knots, whole.knots):
        return np.inf
    u = np.unique(np.append(whole.within((0, 0.25, 0.5, 0.75)), whole.knots[-1]))
    return np.linalg.norm(place(spline.at(u)[0]) - whole.at(u)[0], axis=1).max()


def signed_area(face, solid):
    """Of the outer loop, against the clock round the surface's own normal."""
    kind, *about = face["surface"]
    points = np.concatenate([curve_points(solid.edges[e], forward)[:-1] for e, forward in face["loops"][0]])
    if kind == "plane":
        normal = about[1]
        side = np.cross(normal, (0, 0, 1) if abs(normal[2]) < 0.5 else (0, 1, 0))
        side /= np.linalg.norm(side)
        x, y = points @ side, points @ np.cross(normal, side)
    elif kind == "cylinder":
        from_axis = points - about[0]
        x, y = np.unwrap(np.arctan2(from_axis[:, 1], from_axis[:, 0])), points[:, 2]
    elif kind in ("bore", "cone"):
        origin, axis, side = about[:3]
        from_axis = points - origin
        x, y = np.unwrap(np.arctan2(from_axis @ np.cross(axis, side), from_axis @ side)), from_axis @ axis
    else:
        # Between the rulings too: one may be shorter than the way to the next, and slant.
        at, _ = about[0].at(about[0].within((0, 0.5)))
        middle = at.mean(axis=1)
        along = np.gradient(middle, axis=0)
        k = np.argmin(np.linalg.norm(points[:, None] - middle[None], axis=2), axis=1)
        beside = np.einsum("pi,pi->p", points - middle[k], along[k]) / np.einsum("pi,pi->p", along[k], along[k])
        x = np.clip(k + np.clip(beside, -1, 1), 0, len(at) - 1)
        low = np.minimum(x.astype(int), len(at) - 2)
        foot, far = np.moveaxis(at[low] + (x - low)[:, None, None] * (at[low + 1] - at[low]), 1, 0)[:2]
        y = np.einsum("pi,pi->p", points - foot, far - foot) / np.einsum("pi,pi->p", far - foot, far - foot)
    return 0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)


def faults(solid, genus):
    """What is wrong with a solid; empty for one that is whole."""
    out, uses = [], {}
    about_axis = {f["surface"][2] for f in solid.faces if f["surface"][0] == "cylinder" and not np.any(f["surface"][1])}
    for i, face in enumerate(solid.faces):
        for loop in face["loops"]:
            for (edge, forward), (after, next_forward) in zip(loop, loop[1:] + loop[:1]):
                uses.setdefault(edge, []).append((i, forward))
                end = solid.edges[edge]["ends"][1 if forward else 0]
                if end != solid.edges[after]["ends"][0 if next_forward else 1]:
                    out.append(f"face {i}: a loop is torn")
        area = signed_area(face, solid)
        if (area > 0) != face["same"]:
            out.append(f"face {i} {face['name']}: its loop runs against its normal")
        kind = face["surface"][0]
        of_tube = kind == "cylinder" and not np.any(face["surface"][1]) and len(about_axis) > 1  # a plate may have a bore there
        if of_tube and face["same"] != (face["surface"][2] == max(about_axis)):
            out.append(f"face {i}: a wall that looks inwards")
    for edge, about in solid.edges.items():
        if sorted(forward for _, forward in uses.get(edge, [])) != [False, True]:
            out.append(f"edge {edge} is used {uses.get(edge)}")
            continue
        points = curve_points(about)
        ends = max(np.linalg.norm(points[0] - about["points"][0]), np.linalg.norm(points[-1] - about["points"][1]))
        if about["curve"][0] == "line":
            _, origin, along = about["curve"]
            ends = max(np.linalg.norm(np.cross(p - origin, along / np.linalg.norm(along))) for p in about["points"])
        if about["curve"][0] == "arc":
            origin, z, _, radius = about["curve"][1:]
            ends = max(max(abs(np.linalg.norm(p - origin) - radius), abs((p - origin) @ z)) for p in about["points"])
        if about["curve"][0] == "circle":
            ends = max(abs(np.hypot(*(p - about["curve"][1])[:2]) - about["curve"][2]) for p in about["points"])
        if not ends <= NEAR:
            out.append(f"edge {edge}: {ends:.2g} mm from its vertices")
        for face, _ in uses[edge]:
            off = off_surface(solid.faces[face]["surface"], points).max()
            if not off <= NEAR:
                out.append(f"edge {edge}: {off:.2g} mm off face {face}")
        for flat in about["flats"]:
            if flat[0] not in [solid.faces[face]["number"] for face, _ in uses[edge]]:
                out.append(f"edge {edge}: a curve on a surface of neither face")
            off = off_flat(about, flat)
            if not off <= FLAT_OFF:
                out.append(f"edge {edge}: {off:.2g} mm from what it is on its cylinder")
    loops = sum(len(face["loops"]) for face in solid.faces)
    vertices = {v for edge in solid.edges.values() for v in edge["ends"]}
    characteristic = len(vertices) - len(solid.edges) + 2 * len(solid.faces) - loops
    if characteristic != 2 * (1 - genus):
        out.append(f"Euler's characteristic is {characteristic}, not that of genus {genus}")
    return out
