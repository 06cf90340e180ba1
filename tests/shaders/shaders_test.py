"""The walks of shaders/ against voxdag_cast(), and the example engine, on a graphics card in software.

  VOXDAG=program python3 shaders_test.py SOURCES

Ends with status 77 if a program or a driver is not installed. tests/browser/shaders.test.mjs tests voxdag.wgsl.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

DRIVER = Path("/usr/share/vulkan/icd.d/lvp_icd.x86_64.json")
for program in ("cmake", "glslangValidator", "spirv-val", "xvfb-run"):
    if not shutil.which(program):
        print("skipped: no", program)
        sys.exit(77)
for file in (DRIVER, Path("/usr/include/vulkan/vulkan.h"), Path("/usr/include/GLFW/glfw3.h")):
    if not file.exists():
        print("skipped: no", file)
        sys.exit(77)
SOURCES = Path(sys.argv.pop())


def run(*command, status=0):
    """Runs a program and returns what it prints."""
    result = subprocess.run([*map(str, command)], capture_output=True, text=True, env={
        **os.environ, "VK_ICD_FILENAMES": str(DRIVER), "LIBGL_ALWAYS_SOFTWARE": "1", "XDG_RUNTIME_DIR": FOLDER.name})
    assert result.returncode == status, f"{command}\n{result.stdout}{result.stderr}"
    return result.stdout + result.stderr


def setUpModule():
    global FOLDER, PATH
    FOLDER = tempfile.TemporaryDirectory()
    PATH = Path(FOLDER.name)
    for example in ("vulkan", "engine"):
        run("cmake", "-G", "Ninja", "-S", SOURCES / "examples" / example, "-B", PATH / example, "-DCMAKE_BUILD_TYPE=Release")
        run("cmake", "--build", PATH / example)


def tearDownModule():
    FOLDER.cleanup()


def scene(name, resolution):
    """Builds a procedural scene."""
    file = PATH / f"{name}-{resolution}.vdag"
    run(os.environ["VOXDAG"], "scene", name, "-o", PATH / f"{name}.ply", "-q")
    run(os.environ["VOXDAG"], "build", PATH / f"{name}.ply", "-r", resolution, "-o", file, "-q")
    return file


def read_ppm(path):
    """Returns the bytes of the pixels, and the width."""
    data = path.read_bytes()
    header = re.match(rb"P6\n(\d+) \d+\n255\n", data)
    return data[header.end():], int(header[1])


class Shaders(unittest.TestCase):
    def test_are_valid(self):
        for language in ("glsl", "hlsl"):
            run("spirv-val", "--target-env", "vulkan1.1", PATH / "vulkan" / f"cast_rays.{language}.spv")

    def test_hit_what_voxdag_cast_hits(self):
        # Grids whose root is a leaf block, the parent of leaf blocks, and far above them.
        for name, resolution, count in (("sponge", 4, 100_000), ("sponge", 8, 100_000), ("sponge", 512, 300_000),
                                        ("courtyard", 1024, 500_000)):
            file = scene(name, resolution)
            found = {run(PATH / "vulkan/cast_rays", PATH / "vulkan" / f"cast_rays.{language}.spv", file, count)
                     for language in ("glsl", "hlsl")}
            self.assertEqual(len(found), 1)
            self.assertRegex(found.pop(), rf": {count} rays, [1-9]\d+ hits, 0 differ")

    def test_take_a_scene_without_voxels(self):
        empty = PATH / "empty.vdag"
        run(os.environ["VOXDAG"], "crop", scene("sponge", 8), "--window", "3,3,3,4,4,4", "-o", empty, "-q")
        for language in ("glsl", "hlsl"):
            self.assertRegex(run(PATH / "vulkan/cast_rays", PATH / "vulkan" / f"cast_rays.{language}.spv", empty, 1000),
                             "1000 rays, 0 hits, 0 differ")


class Engine(unittest.TestCase):
    def walk(self, file, *options, status=0):
        return run("xvfb-run", "-a", PATH / "engine/walk", file, *options, status=status)

    def feet(self, *options):
        text = self.walk(scene("courtyard", 512), "--height", "1.8", *options)
        return [float(number) for number in re.fullmatch(r"feet at (\S+) (\S+) (\S+)\n", text).groups()]

    def test_falls_to_the_floor_walks_and_does_not_pass_walls(self):
        start = ("--at", "0,2,3", "--keys")
        landed = self.feet(*start, "....")
        self.assertLess(landed[1], 2)
        self.assertEqual(landed, self.feet(*start, "........"))
        ahead = self.feet(*start, "....ww")
        self.assertAlmostEqual(ahead[0], 1.5 * 1.8, delta=0.01)
        far = self.feet(*start, "...." + 20 * "w")
        self.assertLess(far[0], 20)  # 27 without the wall
        self.assertEqual(far, self.feet(*start, "...." + 30 * "w"))
        back = self.feet(*start, "....wwss")
        self.assertAlmostEqual(back[0], 0, delta=0.01)

    def test_draws_what_is_there(self):
        self.feet("--at", "0,2,3", "--look", "20", "--keys", "....", "--shot", PATH / "a.ppm")
        pixels, width = read_ppm(PATH / "a.ppm")
        self.assertEqual((width, len(pixels)), (960, 960 * 540 * 3))
        self.assertGreater(len(set(pixels)), 60)  # shades
        self.feet("--at", "0,2,3", "--look", "20", "--keys", "....d", "--shot", PATH / "b.ppm")
        self.assertNotEqual(pixels, read_ppm(PATH / "b.ppm")[0])

    def test_says_in_one_line_what_is_wrong(self):
        (PATH / "bad.vdag").write_bytes(b"nothing")
        for arguments, message in (((PATH / "none.vdag",), "none.vdag: cannot open"),
                                   ((PATH / "bad.vdag",), "bad.vdag: "),
                                   ((scene("sponge", 8), "--jump", "1"), "unknown option --jump"),
                                   ((scene("sponge", 8), "--at", "1,2"), "--at needs X,Y,Z"), ((), "usage")):
            text = run("xvfb-run", "-a", PATH / "engine/walk", *arguments, status=1)
            self.assertIn(message, text)
            self.assertEqual(text.count("\n"), 1)


if __name__ == "__main__":
    unittest.main()
