"""The scenes of both papers, and the meshes that stand for them.

A published figure stands beside a measured one only for the same scene, or for a variant that is
labelled as one.
"""

import hashlib
import json
import os
import re
import subprocess
from dataclasses import dataclass, field

from cells import Cell
from child import run_child
from document import Error, Paragraph, Section, Table

SVDAG, ESVO = "svdag", "esvo"
STATES = ["same", "variant", "stand-in"]  # the best first

# SHA-256 of the mesh files of real scenes.
SPONZA = "0bdea4d6be355072bddccbd8d4583063f056128ff63274f61c24434b409121f0"
SANMIGUEL = "53aa1a38116d0626bc676bb0e358839918edabd7eb289e413f612e69ea2e9078"
PLANTS = "61c06ad3c0011c97aa40937e4d96d79ce24dd1e70b48af4858673d6758061c5b"
LUCY = "c57a95174c3c24d87c1ce8b44f48cbf0a5fcab47ce938880ec2acd497a478eb3"
SIBENIK = "dc53c3dfaf5499d3838736aa6806b7d1d11f53bcef7cb7d820b1b5ee15eac61d"
KITCHEN = "b52017a8ce16fcccc3100e229342db2dca4dc944c74aec03f61a85fa5aee0e45"

# Flights through real scenes, whose first key shows the scene.
FLIGHTS = {SPONZA: "crytek_sponza", SANMIGUEL: "sanmiguel", SIBENIK: "sibenik"}


@dataclass(frozen=True)
class PaperScene:
    paper: str
    name: str  # as in the paper's tables
    triangles: int = 0  # as the paper says, rounded; 0: it does not say


PAPER_SCENES = [
    PaperScene(SVDAG, "Crysponza", 279_000), PaperScene(SVDAG, "EpicCitadel"),
    PaperScene(SVDAG, "SanMiguel", 10_500_000), PaperScene(SVDAG, "Hairball", 2_800_000),
    PaperScene(SVDAG, "Lucy", 28_000_000), PaperScene(ESVO, "City"), PaperScene(ESVO, "Sibenik"),
    PaperScene(ESVO, "Sibenik-D"), PaperScene(ESVO, "Hairball"), PaperScene(ESVO, "Fairy"),
    PaperScene(ESVO, "Conference"),
]

# Meshes whose relation to a scene is known: paper, scene, SHA-256 of the file or name of the procedural
# scene, whether its surface is displaced, state, difference.
KNOWN = [
    (SVDAG, "Crysponza", SPONZA, False, "variant",
     "262,267 triangles of the model as it is published today, 279 thousand in the paper"),
    (SVDAG, "SanMiguel", SANMIGUEL, False, "variant", "1,647,885 triangles without plants, 10.5 million in the paper"),
    (SVDAG, "SanMiguel", PLANTS, False, "stand-in", "only some of the plants"),
    (SVDAG, "Lucy", LUCY, False, "variant", "99,970 triangles, 28 million in the paper"),
    (SVDAG, "Hairball", "hairball", False, "stand-in", "a procedural hairball"),
    (SVDAG, "EpicCitadel", "city", False, "stand-in", "a procedural city"),
    (SVDAG, "SanMiguel", "courtyard", False, "stand-in", "a procedural courtyard"),
    (ESVO, "Sibenik", SIBENIK, False, "variant",
     "80,479 triangles and no textures; the paper does not say how many it has"),
    (ESVO, "Sibenik-D", SIBENIK, True, "variant", "80,479 triangles, displaced by another height texture"),
    (ESVO, "Conference", KITCHEN, False, "stand-in", "a furnished kitchen"),
    (ESVO, "Hairball", "hairball", False, "stand-in", "a procedural hairball"),
    (ESVO, "City", "city", False, "stand-in", "a procedural city"),
    (ESVO, "Sibenik", "courtyard", False, "stand-in", "a procedural courtyard"),
    (ESVO, "Sibenik-D", "courtyard", True, "stand-in", "a procedural courtyard, its surface displaced by stones"),
]


@dataclass
class Identity:
    """A mesh that is measured."""
    name: str  # of its file or of its procedural scene
    check: str = ""  # SHA-256 of the file
    is_procedural: bool = False
    is_displaced: bool = False
    triangles: int = 0  # as read; 0: not known


@dataclass
class Match:
    """The paper's scene that a mesh stands for."""
    scene: PaperScene
    state: str
    difference: str = ""  # from the paper's scene, in words

    @property
    def has_figures(self):
        """Whether the scene's published figures may stand beside measured ones."""
        return self.state != "stand-in"

    def json(self):
        return {"name": self.scene.name, "state": self.state, "difference": self.difference}


def label_of(match):
    """Returns the JSON of a match as "same as Lucy", or "variant of Lucy: 99,970 triangles, 28 million in the paper"."""
    if match["state"] == "same":
        return f"same as {match['name']}"
    return f"{match['state']} {'of' if match['state'] == 'variant' else 'for'} {match['name']}: {match['difference']}"


def scene_of(paper, name):
    return next(scene for scene in PAPER_SCENES if (scene.paper, scene.name) == (paper, name))


def _letters(name):
    return re.sub("[^a-z]", "", name.lower())


def is_named_like(scene, mesh_name):
    """Returns whether a mesh of this name may be the scene: "my_San_Miguel.obj" may be SanMiguel."""
    return _letters(scene.name) in _letters(mesh_name)


def match_scene(paper, mesh):
    """Returns the Match of a mesh, or None. Known files are recognised by their content. Others are the same as a
    scene if their name has the scene's name in it and their number of triangles is the paper's, within the 4 % by
    which the papers round."""
    key = mesh.name if mesh.is_procedural else mesh.check
    for known_paper, name, known, is_displaced, state, difference in KNOWN:
        if (known_paper, known, is_displaced) == (paper, key, mesh.is_displaced):
            return Match(scene_of(paper, name), state, difference)
    if mesh.is_procedural or mesh.is_displaced:
        return None
    for scene in PAPER_SCENES:
        if (scene.paper == paper and scene.triangles and is_named_like(scene, mesh.name) and
                abs(mesh.triangles - scene.triangles) <= 0.04 * scene.triangles):
            return Match(scene, "same")
    return None


def stand_in_of(scene):
    """Returns the name of the procedural scene that can stand in for a paper's scene; or ""."""
    for paper, name, known, *_ in KNOWN:
        if (paper, name) == (scene.paper, scene.name) and len(known) < 64:
            return known
    return ""


@dataclass
class FoundScene:
    """A scene of a paper, and the mesh that stands for it."""
    scene: PaperScene
    match: Match = None
    identity: Identity = None
    mesh: str = ""  # its file; "" if no mesh stands for the scene
    made_with: list = field(default_factory=list)  # NAME and options of `voxdag scene`
    options: list = field(default_factory=list)  # of `build` for an ESVO: the displacement

    @property
    def name(self):
        return self.scene.name

    @property
    def is_absent(self):
        return not self.mesh

    @property
    def state(self):
        return "absent" if self.is_absent else self.match.state

    @property
    def title(self):
        return f"{self.name} ({self.state})"

    @property
    def has_figures(self):
        return self.match is not None and self.match.has_figures

    @property
    def shows_published(self):
        """Whether the paper's figures belong into the tables: beside ours, or without ours."""
        return self.has_figures or self.is_absent

    def json(self):
        return {"scene": self.name, "state": self.state, "difference": self.match.difference if self.match else "",
                "mesh": os.path.basename(self.mesh)}


def prepare_mesh(mesh, folder, program):
    """Returns the path and the Identity of a mesh: a file, or a procedural scene NAME or NAME:SIZE, which is made in
    `folder`. Reads the file, so that the next reader finds it in memory. Raises Error."""
    path = os.path.abspath(mesh)
    identity = Identity(os.path.basename(path))
    name, _, size = mesh.partition(":")
    if is_procedural(mesh, program):
        path = os.path.join(folder, mesh + ".ply")
        identity = Identity(name, is_procedural=True)
        if not os.path.exists(path):
            made = run_child([program.path, "scene", name, "-o", path] + (["--size", size] if size else []), folder)
            if made.status:
                raise Error(f"{mesh}: {made.failure(0)}")
    check = hashlib.sha256()
    try:
        with open(path, "rb") as file:
            while part := file.read(1 << 20):
                check.update(part)
    except OSError as error:
        raise Error(f"{path}: {error.strerror}") from error
    identity.check = check.hexdigest()
    return path, identity


def procedural_scenes(program):
    """Returns the names of all procedural scenes."""
    listed = subprocess.run([program.path, "scene", "--list", "--json"], capture_output=True, check=True)
    return [scene["name"] for scene in json.loads(listed.stdout)]


def is_procedural(mesh, program):
    return (re.fullmatch(r"[a-z_]+(:[^/]*)?", mesh) is not None and not os.path.exists(mesh) and
            mesh.partition(":")[0] in procedural_scenes(program))


MESH_ENDINGS = (".obj", ".ply", ".stl", ".off", ".gltf", ".glb")
SMALL_SIZES = {"hairball": 300, "city": 2, "courtyard": 0.4}  # about half a million triangles


def mesh_files(folder):
    """Returns the mesh files in the folder and below, sorted by path."""
    def fail(error):
        raise Error(f"{error.filename}: {error.strerror}")
    return sorted(os.path.abspath(os.path.join(path, name)) for path, _, names in os.walk(folder, onerror=fail)
                  for name in names if name.endswith(MESH_ENDINGS))


def _displacement(mesh):
    # Stones of about 1 m: Sibenik's unit is about 0.3 m, those of procedural scenes are metres.
    return ["--displace", "stone:0.03:1.3" if mesh.is_procedural else "stone:0.15:4"] if mesh.is_displaced else []


class SceneFinder:
    """Finds the meshes for the scenes of both papers: first the paper's own, then a variant, then a stand-in.
    Procedural stand-ins are made in `made`. Registers the meshes as inputs of the cells."""

    def __init__(self, plan, made, cells, program):
        self.plan, self.made, self.cells, self.program = plan, made, cells, program
        self.found = {}
        for file in mesh_files(plan.scenes) if plan.scenes else []:
            self._look_at(file)

    def scenes_of(self, paper):
        """Returns a FoundScene for each scene of the paper in the order of its tables."""
        return [self._best_for(scene) for scene in PAPER_SCENES
                if scene.paper == paper and (not self.plan.only or scene.name in self.plan.only)]

    def _best_for(self, scene):
        stand_in = stand_in_of(scene)
        if scene not in self.found and stand_in:
            size = SMALL_SIZES.get(stand_in) if self.plan.small_stand_ins else None
            made_with = [stand_in] + (["--size", f"{size:g}"] if size else [])
            self._prepare(f"{stand_in}:{size:g}" if size else stand_in, made_with)
        return self.found.get(scene, FoundScene(scene))

    def _prepare(self, file, made_with=()):
        """Considers the mesh as it is and displaced."""
        path, identity = prepare_mesh(file, self.made, self.program)
        self.cells.contents[path] = identity.check
        for is_displaced in (False, True):
            self._consider(path, Identity(identity.name, identity.check, identity.is_procedural, is_displaced), made_with)
        return path, identity

    def _look_at(self, file):
        path, identity = self._prepare(file)
        # A mesh that is not known by its content may be a paper's by its name and triangle count.
        if any(scene.triangles and is_named_like(scene, identity.name) for scene in PAPER_SCENES):
            counted = self.cells.run(Cell(["build", path, "-r", "4", "-o", "/dev/null", "--json"], [path]))
            identity.triangles = 0 if counted.failure else counted.json["source"]["triangles"]
            self._consider(path, identity, ())

    def _consider(self, path, identity, made_with):
        for paper in (SVDAG, ESVO):
            match = match_scene(paper, identity)
            if match is None:
                continue
            best = self.found.get(match.scene)
            if best is None or STATES.index(match.state) < STATES.index(best.match.state):
                self.found[match.scene] = FoundScene(match.scene, match, identity, path, list(made_with),
                                                     _displacement(identity))


def flight_through(scene, program):
    """Returns the camera path through a scene as `voxdag render --path` reads it, or "" if none is known."""
    if scene.is_absent:
        return ""
    if scene.identity.is_procedural:
        return run_child([program.path, "scene", *scene.made_with, "--path"], "/").out
    name = FLIGHTS.get(scene.identity.check)
    if name is None:
        return ""
    with open(os.path.join(os.path.dirname(__file__), "flights", name + ".json"), encoding="utf-8") as file:
        return file.read()


def view_of(scene, program, options=("--eye", "--target", "--up", "--fov", "--sun")):
    """Returns these options of `render`: a camera that shows the scene well, and a sun that goes with it. None if nothing
    is known about the scene."""
    path = flight_through(scene, program)
    if not path:
        return []
    if scene.identity.is_procedural:
        words = run_child([program.path, "scene", *scene.made_with, "--view"], "/").out.split()
        view = dict(zip(words[::2], words[1::2]))
    else:
        def commas(vector):
            return ",".join(f"{x:.6g}" for x in vector)
        flight = json.loads(path)
        key = flight["keys"][0]
        view = {"--eye": commas(key["eye"]), "--target": commas(key["target"]), "--up": commas(key["up"]),
                "--fov": f"{key['fov']:.6g}", "--sun": commas(flight["sun"])}
    return [word for option in options for word in (option, view[option])]


def camera_of(scene, program):
    """Returns view_of() without the sun."""
    return view_of(scene, program, ("--eye", "--target", "--up", "--fov"))


def scenes_section(scenes):
    """Returns a table of the scenes, their states and their meshes."""
    rows = [[scene.name, scene.state, "–", "no such mesh was found"] if scene.is_absent else
            [scene.name, scene.state, " ".join([os.path.basename(scene.mesh), *scene.options]), scene.match.difference]
            for scene in scenes]
    return Section("The scenes", 2, [
        Paragraph("Published figures stand beside ours only if the mesh is the paper's scene (same) or another version "
                  "of it (variant). A stand-in is another model of the same kind."),
        Table("Scenes of the paper", ["scene", "state", "mesh", "difference"], rows, 4)])
