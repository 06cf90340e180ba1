"""Live edits: Dag.edit()."""
import numpy as _numpy

from . import _voxdag


def _rows(**parameters):
    """Joins arrays of shape (n, width) or (width,) to one of (n, sum of widths).

    parameters: name=(array, width). A width of 1 takes (n,) or a number.
    """
    parts = []
    for name, (given, width) in parameters.items():
        array = _numpy.asarray(given, dtype=float)
        if width == 1:
            array = array.reshape(-1, 1) if array.ndim <= 1 else array
        elif array.ndim == 1:
            array = array.reshape(1, -1)
        if array.ndim != 2 or array.shape[1] != width:
            shape = "a number or (n,)" if width == 1 else f"({width},) or (n, {width})"
            raise ValueError(f"{name} must have the shape {shape}, not {_numpy.shape(given)}")
        parts.append(array)
    counts = {len(part) for part in parts} - {1}
    if len(counts) > 1:
        raise ValueError(f"{', '.join(parameters)} must have as many rows as each other, or one")
    count = counts.pop() if counts else 1
    return _numpy.concatenate([_numpy.broadcast_to(p, (count, p.shape[1])) for p in parts], axis=1)


def _colors(color):
    if color is None:
        return None
    array = _numpy.asarray(color)
    return array.reshape(1, -1) if array.ndim == 1 else array


class Edit:
    """Edits of a Dag, which stays as it is. Make one with Dag.edit().

        with dag.edit() as e:
            e.remove_ball((1, 2, 0.5), 0.3)
            e.paint_box((0, 0, 0), (4, 4, 1), color=(255, 128, 0))
            e.undo()
        edited = e.dag()

    An edit takes time for what it touches, not for the scene. Shapes are in world units; a voxel
    belongs to a shape if its centre does. Each parameter of a shape may also be an array with one
    row for each of n shapes: (n, 3) centres and (n,) radii make n edits, in their order.

    color: sRGB, (3,) or (n, 3) uint8; material: a number. Voxels that are added without them take
    those of the nearest voxel; replace_*() gives them to old and new voxels. Bad arguments raise
    ValueError, and then nothing has changed.
    """

    def __init__(self, dag, history=0):
        self._live = _voxdag._LiveEdit(dag, history)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None

    def _apply(self, verb, shape, color=None, material=None, **parameters):
        self._live.apply(verb, shape, _numpy.ascontiguousarray(_rows(**parameters)),
                         _colors(color), material)

    def add_ball(self, center, radius, *, color=None, material=None):
        """Adds the voxels at most radius from center."""
        self._apply("add", "ball", color, material, center=(center, 3), radius=(radius, 1))

    def remove_ball(self, center, radius):
        """Removes the voxels at most radius from center."""
        self._apply("remove", "ball", center=(center, 3), radius=(radius, 1))

    def paint_ball(self, center, radius, *, color=None, material=None):
        """Gives a colour or a material to the voxels at most radius from center."""
        self._apply("paint", "ball", color, material, center=(center, 3), radius=(radius, 1))

    def replace_ball(self, center, radius, *, color=None, material=None):
        """Adds and paints the voxels at most radius from center."""
        self._apply("replace", "ball", color, material, center=(center, 3), radius=(radius, 1))

    def add_box(self, lo, hi, *, color=None, material=None):
        """Adds the voxels of the box from lo to hi."""
        self._apply("add", "box", color, material, lo=(lo, 3), hi=(hi, 3))

    def remove_box(self, lo, hi):
        """Removes the voxels of the box from lo to hi."""
        self._apply("remove", "box", lo=(lo, 3), hi=(hi, 3))

    def paint_box(self, lo, hi, *, color=None, material=None):
        """Gives a colour or a material to the voxels of the box from lo to hi."""
        self._apply("paint", "box", color, material, lo=(lo, 3), hi=(hi, 3))

    def replace_box(self, lo, hi, *, color=None, material=None):
        """Adds and paints the voxels of the box from lo to hi."""
        self._apply("replace", "box", color, material, lo=(lo, 3), hi=(hi, 3))

    def add_turned_box(self, center, half, turn, *, color=None, material=None):
        """Adds the voxels of a box with half sides `half`, turned about its center by the
        quaternion turn (x, y, z, w)."""
        self._apply("add", "turnedbox", color, material, center=(center, 3), half=(half, 3),
                    turn=(turn, 4))

    def remove_turned_box(self, center, half, turn):
        """Removes the voxels of a turned box: see add_turned_box()."""
        self._apply("remove", "turnedbox", center=(center, 3), half=(half, 3), turn=(turn, 4))

    def paint_turned_box(self, center, half, turn, *, color=None, material=None):
        """Gives a colour or a material to the voxels of a turned box: see add_turned_box()."""
        self._apply("paint", "turnedbox", color, material, center=(center, 3), half=(half, 3),
                    turn=(turn, 4))

    def replace_turned_box(self, center, half, turn, *, color=None, material=None):
        """Adds and paints the voxels of a turned box: see add_turned_box()."""
        self._apply("replace", "turnedbox", color, material, center=(center, 3), half=(half, 3),
                    turn=(turn, 4))

    def add_capsule(self, start, end, radius, *, color=None, material=None):
        """Adds the voxels at most radius from the segment from start to end: a brush stroke."""
        self._apply("add", "capsule", color, material, start=(start, 3), end=(end, 3),
                    radius=(radius, 1))

    def remove_capsule(self, start, end, radius):
        """Removes the voxels at most radius from the segment from start to end."""
        self._apply("remove", "capsule", start=(start, 3), end=(end, 3), radius=(radius, 1))

    def paint_capsule(self, start, end, radius, *, color=None, material=None):
        """Gives a colour or a material to the voxels at most radius from a segment."""
        self._apply("paint", "capsule", color, material, start=(start, 3), end=(end, 3),
                    radius=(radius, 1))

    def replace_capsule(self, start, end, radius, *, color=None, material=None):
        """Adds and paints the voxels at most radius from a segment."""
        self._apply("replace", "capsule", color, material, start=(start, 3), end=(end, 3),
                    radius=(radius, 1))

    def add_half_space(self, point, normal, *, color=None, material=None):
        """Adds the voxels of the grid on the side of a plane that its normal points away from."""
        self._apply("add", "halfspace", color, material, point=(point, 3), normal=(normal, 3))

    def remove_half_space(self, point, normal):
        """Removes the voxels on the side of a plane that its normal points away from."""
        self._apply("remove", "halfspace", point=(point, 3), normal=(normal, 3))

    def paint_half_space(self, point, normal, *, color=None, material=None):
        """Gives a colour or a material to the voxels on the side of a plane that its normal points
        away from."""
        self._apply("paint", "halfspace", color, material, point=(point, 3), normal=(normal, 3))

    def replace_half_space(self, point, normal, *, color=None, material=None):
        """Adds and paints the voxels on the side of a plane that its normal points away from."""
        self._apply("replace", "halfspace", color, material, point=(point, 3), normal=(normal, 3))

    def smooth(self, center, radius):
        """Sets each voxel of a ball if at least 14 of the 27 voxels around it are set."""
        self._apply("smooth", "ball", center=(center, 3), radius=(radius, 1))

    def grow(self, center, radius):
        """Adds the voxels of a ball that share a face with a voxel."""
        self._apply("grow", "ball", center=(center, 3), radius=(radius, 1))

    def shrink(self, center, radius):
        """Removes the voxels of a ball that share a face with a place without a voxel."""
        self._apply("shrink", "ball", center=(center, 3), radius=(radius, 1))

    def copy(self, lo, hi, to):
        """Copies the voxels of the box from lo to hi, with their values, to where lo is `to`,
        rounded to whole voxels."""
        self._apply("copy", "", lo=(lo, 3), hi=(hi, 3), to=(to, 3))

    def move(self, lo, hi, to):
        """Moves the voxels of a box: copy(), and the box itself becomes empty first."""
        self._apply("move", "", lo=(lo, 3), hi=(hi, 3), to=(to, 3))

    def stamp(self, dag, *, at=None, mirror=None, turn=None, mode="add", color=None,
              material=None):
        """Adds or removes the voxels of another Dag with voxels of equal size.

        mirror: 'x', 'y' or 'z'; turn: an axis and a number of quarter turns, ('z', 1). Both are
        applied first. at: where the lower corner of the box of its voxels comes, rounded to whole
        voxels; by default it stays in its place.
        mode: 'add', 'remove', or 'replace': the voxels in its box become exactly its own.
        """
        self._live.stamp(dag, at, mirror, turn, mode, _colors(color), material)

    def add_voxels(self, voxels, *, color=None, material=None):
        """Adds voxels, (N, 3) whole numbers."""
        self._live.change_voxels(voxels, True, _colors(color), material)

    def remove_voxels(self, voxels):
        """Removes voxels, (N, 3) whole numbers."""
        self._live.change_voxels(voxels, False, None, None)

    def undo(self):
        """Goes back one edit. Returns False if there is none."""
        return self._live.undo()

    def redo(self):
        """Goes forward again. Returns False if there is nothing to redo."""
        return self._live.redo()

    @property
    def undo_count(self):
        """The number of edits that undo() can take back."""
        return self._live.counts()[0]

    @property
    def redo_count(self):
        """The number of edits that redo() can bring back."""
        return self._live.counts()[1]

    def snapshot(self):
        """Returns the present version, with cast(), occluded() and render(), in no time."""
        return self._live.snapshot()

    def dag(self):
        """Returns the present version as a Dag."""
        return self._live.dag()


def edit(dag, history=0):
    """Begins edits of the Dag, which itself stays as it is: see voxdag.Edit.

    history: the number of edits that undo() can take back; 0: all.
    """
    return Edit(dag, history)
