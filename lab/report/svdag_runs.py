"""What the chapter about the SVDAG paper runs, and what the builds printed."""

import json

import published
from cells import build_series, series_json
from flight import flight_items, flight_scene, trace_path, write_path
from pictures import paint, show
from scenes import STATES, flight_through, view_of

MEBIBYTE = 1 << 20

# The series of builds of each scene: the key in the JSON, how they are built, and the plan's resolutions.
SERIES = {"paper_method": ("paper", "table1"), "voxdag_method": ("hash", "table1"), "dags": ("hash", "table2"),
          "esvos": ("esvo", "table2"), "esvo_shapes": ("shape", "table2")}


def dag_nodes(build):
    return build.json["dag_nodes"]


def dag_bytes(build):
    return build.json["bytes"]["svdag_paper"]


def svo_nodes(build):
    return build.json["svo_nodes"]


def esvo_nodes(build):
    return build.json["descriptors"]


def esvo_bytes(build):
    """Returns the bytes as the paper counts them: 8 per node for its child mask, contour and pointer."""
    return 8 * esvo_nodes(build)


def stage(name):
    return lambda build: build.json["seconds"][name]


def wall_seconds(build):
    return build.cost["wall_seconds"]


# Work.

def _paint_scene(lab, scene, is_first):
    """Returns the pictures of Figure 4 and, of the first scene, those of Figure 8b."""
    voxels = show(lab, scene, lab.plan.picture_levels)
    view = view_of(scene, lab.program)
    pictures = [paint(lab, voxels, f"svdag-figure4-{scene.name}.png", view + ["--mesh", scene.mesh, "--sun-angle", "2"])]
    if is_first:
        pictures += [paint(lab, voxels, f"svdag-figure8b-{name}.png", view + ["--lod", "0"] + options, of_pass="occlusion")
                     for name, options in (("exact", []), ("cones", ["--ao-cone", "0.07"]))]
    return pictures


def _scene_of_figure1(lab, scenes):
    """Returns the scene that is closest to the paper's and has a view: EpicCitadel if others are no closer; or None."""
    candidates = [scene for scene in scenes if flight_through(scene, lab.program)]
    return min(candidates, default=None, key=lambda scene: (STATES.index(scene.state),
                                                            scene.name != published.FIGURE1["scene"]))


def _figure1(lab, scene):
    """Returns the build, the picture and the rays of the picture's view."""
    plan = lab.plan
    voxels = show(lab, scene, plan.figure1)
    view = view_of(scene, lab.program)
    picture = paint(lab, voxels, "svdag-figure1.png", view + ["--mesh", scene.mesh])
    options = dict(zip(view[::2], view[1::2]))
    eye, target, up, sun = (json.loads(f"[{options[name]}]") for name in ("--eye", "--target", "--up", "--sun"))
    key = {"time": 0, "eye": eye, "target": target, "up": up, "fov": json.loads(options["--fov"])}
    path = write_path(lab, "view.json", json.dumps({"sun": sun, "keys": [key]}) + "\n")
    return voxels.built, picture, trace_path(lab, scene, voxels.path, plan.figure1, path, 1,
                                             failure=voxels.built.failure)


def svdag_items(lab, scenes):
    """Returns the runs of the chapter as items of work, about the longest first: functions by key."""
    plan, items = lab.plan, {}
    present = [scene for scene in scenes if not scene.is_absent]
    scene, path = flight_scene(lab, present)
    if scene is not None:
        items.update(flight_items(lab, scene, path))
    of_figure1 = _scene_of_figure1(lab, present)
    if of_figure1 is not None:
        items["figure1"] = lambda: _figure1(lab, of_figure1)

    def series(scene, *names):
        def run():
            return {name: build_series(plan, SERIES[name][0], scene, getattr(plan, SERIES[name][1]), lab.cells)
                    for name in names}
        return run
    for scene in present:
        # The tables share some of the builds by hash.
        for names in (("esvos",), ("esvo_shapes",), ("paper_method",), ("voxdag_method", "dags")):
            items["svdag builds", scene.name, *names] = series(scene, *names)
    for scene in present:
        items["svdag pictures", scene.name] = (lambda scene=scene: _paint_scene(lab, scene, scene is present[0]))
    return items


class SvdagResults:
    """What the items returned. `builds` has the series of each scene by name."""

    def __init__(self, plan, scenes, results):
        self.plan, self.scenes = plan, scenes
        self.builds = []
        for scene in scenes:
            series = {name: [] for name in SERIES}
            for key, result in results.items():
                if key[:2] == ("svdag builds", scene.name):
                    series.update(result)
            self.builds.append((scene, series))
        self.figure1 = results.get("figure1")
        self.pictures = [results["svdag pictures", scene.name] for scene in scenes if not scene.is_absent]
        self.flying, runs = results.get("flight", (None, {}))  # the scene of the fly-through
        self.flight = {**results["flight_esvo"][1], **runs} if self.flying else None

    def json(self):
        figure1 = None
        if self.figure1:
            build, picture, rays = self.figure1
            figure1 = {"scene": picture.scene.name, "state": picture.scene.state, "build": build.failure or build.json,
                       "picture": picture.cell.command(), "rays": rays.json()}
        flight = self.flight and {"scene": self.flying.name, "state": self.flying.state,
                                  **{name: run.json() for name, run in self.flight.items()}}
        return {"scenes": [{**scene.json(), **{name: series_json(runs) for name, runs in series.items()}}
                           for scene, series in self.builds], "figure1": figure1, "flight": flight}
