"""Pages in notebooks and browsers, extensions of either case, and help()."""
import base64
import html
import inspect
import pydoc
import re
import urllib.error
import urllib.request
import warnings

import numpy as np
import pytest

import voxdag
from shapes import CUBE, CUBE_FACES, as_set, random_coords

PUBLIC = [name for name in dir(voxdag.Dag) if not name.startswith("_")]


@pytest.fixture
def dag():
    return voxdag.from_coords(random_coords(16, 100), resolution=16, pitch=0.5)


def test_a_page_is_one_file_with_the_scene(dag, tmp_path):
    assert dag.export(tmp_path / "a.html", title='A "castle" <1>') == [tmp_path / "a.html"]
    page = (tmp_path / "a.html").read_text()
    assert '<title>A &quot;castle&quot; &lt;1></title>' in page
    assert r'{"version":1,"title":"A \"castle\" \u003c1>"}' in page
    scene = re.search(r'id="scene">([^<]*)</script>', page)[1]
    assert base64.b64decode(scene)[:2] == b"\x1f\x8b"
    dag.export(tmp_path / "B.HTML", title='A "castle" <1>')
    assert (tmp_path / "B.HTML").read_text() == page
    with pytest.raises(ValueError, match="a page has no choices but colors and title"):
        dag.export(tmp_path / "c.html", merge=True)
    with pytest.raises(ValueError, match="title is for pages"):
        dag.export(tmp_path / "c.obj", title="A")
    with pytest.raises(ValueError, match=r"or \.html"):
        dag.export(tmp_path / "c.htm")


def test_notebooks_show_a_small_picture_and_on_request_the_page(dag):
    small = dag._repr_html_()
    assert len(small) < 100_000 and "16³ grid, 100 voxels of 0.5" in small.replace(str(len(dag)), "100")
    assert base64.b64decode(re.search("base64,([^\"]*)", small)[1])[:3] == b"\xff\xd8\xff"
    frame = dag.show(title="Cubes", height=300)
    page = html.unescape(re.search('srcdoc="([^"]*)"', frame._repr_html_())[1])
    assert page.startswith("<!doctype html>") and "<title>Cubes</title>" in page
    assert 'height="300"' in frame._repr_html_() and "view() opens it" in repr(frame)


def test_view_serves_the_page_until_it_is_closed(dag, monkeypatch, tmp_path):
    opened = []
    monkeypatch.setattr("webbrowser.open", lambda url: opened.append(url) or True)
    monkeypatch.setenv("DISPLAY", ":0")
    with dag.view(title="Cubes") as view:
        assert opened == [view.url]
        dag.export(tmp_path / "a.html", title="Cubes")
        with urllib.request.urlopen(view.url) as answer:
            assert answer.read() == (tmp_path / "a.html").read_bytes()
            assert answer.headers["Content-Type"] == "text/html; charset=utf-8"
        with pytest.raises(urllib.error.HTTPError, match="404"):
            urllib.request.urlopen(view.url.rsplit("/", 2)[0] + "/")
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(view.url)
    view.close()
    assert "closed" in repr(view)
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    with pytest.warns(UserWarning, match="no browser opened: open http://127.0.0.1:"):
        dag.view().close()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        dag.view(open_browser=False).close()
    assert len(opened) == 1


@pytest.mark.parametrize("name", ["a.stl", "a.glb", "a.ply", "a.npy", "a.nrrd", "a.vox"])
def test_extensions_are_known_in_either_case(dag, tmp_path, name):
    dag.export(tmp_path / name)
    dag.export(tmp_path / name.upper())
    assert (tmp_path / name).read_bytes() == (tmp_path / name.upper()).read_bytes()


def test_rays_take_arrays_of_any_numbers():
    dag = voxdag.build(CUBE, CUBE_FACES, resolution=16, solid=True)
    origins, directions = np.array([[0.5, 0.5, 3.0]] * 4), np.array([[0, 0, -1]] * 4)
    expected = dag.cast(origins.astype(np.float32), directions.astype(np.float32))
    for kind in (np.float64, np.float32, np.int32, np.int64):
        hits = dag.cast(origins, directions.astype(kind), t_max=np.float64(100))
        assert all((hits[name] == expected[name]).all() for name in expected)
    assert dag.cast([[0.5, 0.5, 3]], [[0, 0, -1]])["t_hit"] == expected["t_hit"][0]
    assert dag.occluded(origins, origins * [1.0, 1.0, -1.0]).all()


def test_help_reads_like_documentation():
    text = pydoc.render_doc(voxdag.Dag, renderer=pydoc.plaintext)
    assert "cast(self, origins, directions, *, t_min=0.0, t_max=inf)" in text
    lines = [line for line in text.split("\n") if "__init__" not in line and "__new__" not in line]
    assert not any("_voxdag" in line.replace("voxdag._voxdag", "") or "*args" in line for line in lines)
    functions = [(name, getattr(voxdag.Dag, name)) for name in PUBLIC]
    functions += [(name, getattr(voxdag, name)) for name in voxdag.__all__ if name != "Dag"]
    for name, member in functions:
        words = (member.__doc__ or "").split("\n", 1)
        assert words[0].endswith(".") or name == "info", (name, words[0])
        if not callable(member) or inspect.isclass(member):
            continue
        assert re.match("[A-Z][a-z]+s ", words[0]), (name, words[0])  # a verb: "Returns"
        for argument in inspect.signature(member).parameters:
            assert argument in ("self", "dag", "options") or re.search(rf"\b{argument}\b", member.__doc__), (name, argument)


def test_hollow_bodies_have_a_wall_and_drains():
    body = voxdag.from_dense(np.ones((20, 20, 20)) > 0, resolution=64, pitch=0.5, origin=(-1, -1, -1))
    shell = body.hollow(1.5)
    dense = np.ones((20, 20, 20), bool)
    dense[3:-3, 3:-3, 3:-3] = False
    np.testing.assert_array_equal(shell.to_dense(((0, 0, 0), (20, 20, 20))), dense)
    depths = -body.distance_field(signed=True)
    np.testing.assert_array_equal(shell.to_dense(), (depths > 0) & (depths <= 1.5))
    open_shell = body.hollow(1.5, [(4, 4, -1, 0.8), (4, 4, 9, 0.8)])
    assert len(open_shell) < len(shell) and open_shell.fill_cavities() == open_shell
    with pytest.raises(ValueError, match="no voxels that are deeper than the wall"):
        body.hollow(6)
    with pytest.raises(ValueError, match="drain 1 does not open the cavity"):
        body.hollow(1.5, drains=[(4, 4, 4, 0.8)])
    for wrong in (0, -1, 0.1, np.nan, np.inf):
        with pytest.raises(ValueError, match="wall must be"):
            body.hollow(wrong)
    colored = voxdag.from_coords(body.coords(), resolution=64, colors=body.coords() * 5).hollow(3)
    assert colored.info["has_colors"]


def test_thickness_is_that_of_plates():
    dense = np.zeros((32, 32, 32), bool)
    dense[:, :, 4:9] = True
    plate = voxdag.from_dense(dense, pitch=0.2)
    field = plate.thickness()
    assert field.shape == (32, 32, 32) and field.dtype == np.float32
    assert (field[~dense] == 0).all() and (field[dense] >= np.float32(0.2)).all()
    np.testing.assert_allclose(field[8:24, 8:24, 4:9], 1.0, rtol=1e-6)
    np.testing.assert_array_equal(plate.thickness(((8, 8, 0), (9, 9, 16))), field[8:9, 8:9, :16])
    assert as_set(plate.coords()) == as_set(np.argwhere(field > 0))
