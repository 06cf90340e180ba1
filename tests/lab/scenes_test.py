#!/usr/bin/env python3
"""Tests which scenes of the papers a mesh stands for."""

import json
import unittest

import report_path  # noqa: F401

from scenes import (ESVO, FLIGHTS, LUCY, PAPER_SCENES, SIBENIK, SVDAG, FoundScene, Identity, camera_of, flight_through,
                    label_of, match_scene, view_of)


class PaperScenes(unittest.TestCase):
    def test_a_tetrahedron_named_lucy_is_not_lucy(self):
        self.assertIsNone(match_scene(SVDAG, Identity("lucy.obj", triangles=4)))
        self.assertIsNone(match_scene(ESVO, Identity("sibenik.obj", triangles=1)))

    def test_the_name_and_the_triangle_count_of_the_paper_are_the_scene(self):
        match = match_scene(SVDAG, Identity("Lucy.ply", triangles=28_055_742))
        self.assertEqual((match.scene.name, match.state, match.has_figures), ("Lucy", "same", True))
        self.assertEqual(label_of(match.json()), "same as Lucy")
        self.assertEqual(match_scene(SVDAG, Identity("my_crysponza-2.obj", triangles=279_163)).state, "same")

    def test_a_known_file_is_recognised_by_its_content_under_any_name(self):
        match = match_scene(SVDAG, Identity("scan.ply", LUCY, triangles=99_970))
        self.assertEqual((match.state, match.has_figures), ("variant", True))
        self.assertEqual(label_of(match.json()), "variant of Lucy: 99,970 triangles, 28 million in the paper")

    def test_a_displaced_mesh_is_another_scene(self):
        mesh = Identity("sibenik.obj", SIBENIK, triangles=80_479)
        self.assertEqual(match_scene(ESVO, mesh).scene.name, "Sibenik")
        mesh.is_displaced = True
        self.assertEqual(match_scene(ESVO, mesh).scene.name, "Sibenik-D")

    def test_a_procedural_scene_is_a_stand_in_without_figures(self):
        mesh = Identity("hairball", is_procedural=True, triangles=2_880_000)
        for paper in (SVDAG, ESVO):
            match = match_scene(paper, mesh)
            self.assertEqual((match.state, match.has_figures), ("stand-in", False))
            self.assertEqual(label_of(match.json()), "stand-in for Hairball: a procedural hairball")

    def test_every_paper_has_its_tables(self):
        papers = [scene.paper for scene in PAPER_SCENES]
        self.assertEqual((papers.count(SVDAG), papers.count(ESVO)), (5, 6))


class Flights(unittest.TestCase):
    def scenes(self):
        for check in FLIGHTS:
            mesh = Identity("a.obj", check)
            match = match_scene(SVDAG, mesh) or match_scene(ESVO, mesh)
            yield FoundScene(match.scene, match, mesh, "/a.obj")

    def test_are_through_a_papers_scene(self):
        for scene in self.scenes():
            self.assertTrue(scene.has_figures)

    def test_are_found_by_the_content_of_the_mesh(self):
        for scene in self.scenes():
            self.assertTrue(flight_through(scene, None))
            scene.identity.check = "0" * 64
            self.assertFalse(flight_through(scene, None))

    def test_have_at_least_eight_keys_from_time_zero(self):
        for scene in self.scenes():
            keys = json.loads(flight_through(scene, None))["keys"]
            self.assertGreaterEqual(len(keys), 8)
            self.assertEqual(keys[0]["time"], 0)
            self.assertGreaterEqual(keys[-1]["time"], 20)

    def test_begin_with_the_view_of_the_scene(self):
        sponza = next(self.scenes())
        self.assertEqual(camera_of(sponza, None), ["--eye", "1060,690,78", "--target", "-300,420,-40", "--up", "0,1,0",
                                                   "--fov", "60"])
        self.assertEqual(view_of(sponza, None)[-2:], ["--sun", "0.3,1,0.35"])


if __name__ == "__main__":
    unittest.main()
