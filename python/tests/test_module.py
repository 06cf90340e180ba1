"""Views of the nodes, stubs, threads, and answers to unknown arguments."""
import _thread
import ast
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import voxdag
from shapes import random_coords, write_cube


def test_views_of_the_nodes_are_read_only():
    dag = voxdag.from_coords(random_coords(64, 500), resolution=64)
    assert dag.nodes.dtype == np.uint32 and dag.leaf_blocks.dtype == np.uint64
    assert dag.nodes.nbytes + dag.leaf_blocks.nbytes == dag.info["bytes"]
    nodes = dag.nodes
    first = int(nodes[0])
    del dag
    assert int(nodes[0]) == first  # the view keeps the DAG
    with pytest.raises(ValueError):
        nodes[0] = 0


def test_the_stubs_name_everything():
    stubs = ast.parse((Path(voxdag.__file__).parent / "__init__.pyi").read_text())
    named = {node.name for node in stubs.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    assert set(voxdag.__all__) <= named
    dag = next(n for n in stubs.body if isinstance(n, ast.ClassDef) and n.name == "Dag")
    members = {n.name for n in dag.body if not n.name.startswith("_")}
    assert members == {name for name in dir(voxdag.Dag) if not name.startswith("_")}


def test_other_threads_run_and_ctrl_c_works():
    coords = random_coords(1 << 12, 200_000)
    ticks = []

    def tick():
        while len(ticks) < 5:
            ticks.append(time.monotonic())
            time.sleep(0.01)
        _thread.interrupt_main()

    points = np.random.default_rng(6).uniform(0, 1 << 12, (4_000_000, 3))
    dag = voxdag.from_coords(coords, resolution=1 << 12)
    thread = threading.Thread(target=tick)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        dag.nearest(points)
    thread.join()
    assert len(ticks) == 5


def test_unknown_arguments_are_answered_with_the_nearest(tmp_path):
    write_cube(tmp_path / "cube.obj")
    with pytest.raises(TypeError, match=r"build_mesh\(\) has no argument 'resolutoin': did you mean 'resolution'\?"):
        voxdag.build_mesh(tmp_path / "cube.obj", resolutoin=8)
    dag = voxdag.build_mesh(tmp_path / "cube.obj", resolution=8)
    with pytest.raises(TypeError, match=r"dilate\(\) has no argument 'neighbors': did you mean 'neighbours'\?"):
        dag.dilate(neighbors=6)
    with pytest.raises(TypeError, match="incompatible"):
        dag.dilate("two")
