#!/usr/bin/env python3
"""Draws an exported mesh with Open3D, as a picture for the documentation.

  draw_mesh.py MESH.glb OUT.jpg --front 1,0.05,0.02 --lookat 0,500,-30 --zoom 0.12

--front points from the look-at point to the viewer. Without a display, run it under xvfb-run.
"""
import argparse

import numpy
import open3d
from PIL import Image


def triple(text):
    return [float(number) for number in text.split(",")]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("out")
    parser.add_argument("--front", type=triple, default=[1, 1, 1])
    parser.add_argument("--lookat", type=triple, default=[0, 0, 0])
    parser.add_argument("--up", type=triple, default=[0, 1, 0])
    parser.add_argument("--zoom", type=float, default=0.7)
    arguments = parser.parse_args()

    mesh = open3d.io.read_triangle_mesh(arguments.mesh)
    # glTF has linear colours; Open3D shows colours as they are.
    linear = numpy.asarray(mesh.vertex_colors)
    mesh.vertex_colors = open3d.utility.Vector3dVector(
        numpy.where(linear <= 0.0031308, 12.92 * linear,
                    1.055 * numpy.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055))
    window = open3d.visualization.Visualizer()
    window.create_window(width=1280, height=720, visible=False)
    window.add_geometry(mesh)
    view = window.get_view_control()
    view.set_front(arguments.front)
    view.set_lookat(arguments.lookat)
    view.set_up(arguments.up)
    view.set_zoom(arguments.zoom)
    window.poll_events()
    window.update_renderer()
    pixels = numpy.asarray(window.capture_screen_float_buffer(True))
    Image.fromarray(numpy.rint(pixels * 255).astype(numpy.uint8)).save(arguments.out, quality=88)


if __name__ == "__main__":
    main()
