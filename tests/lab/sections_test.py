#!/usr/bin/env python3
"""Tests the chapters about the papers."""

import unittest

import report_path  # noqa: F401

import esvo
import esvo_runs
import flight
import svdag
import svdag_runs
from cells import Cell, Result, Run
from document import markdown_of
from flight import FlightRun
from papers import Plan
from pictures import ScenePicture
from scenes import ESVO, SVDAG, FoundScene, Match, scene_of


def text_of(*sections):
    return markdown_of("", sections)


def found(paper, name, state):
    scene = scene_of(paper, name)
    return FoundScene(scene, Match(scene, state), mesh=name.lower() + ".obj")


def failed(reason, levels=0):
    return Run(levels, Cell([]), Result(reason))


def lucy(state):
    """Returns a scene that was built as a DAG at 2048³ only."""
    build = Run(11, Cell(["build"]), Result(json={
        "dag_nodes": 1_500_000, "svo_nodes": 20_000_000, "voxels": 80_000_000, "bytes": {"svdag_paper": 4 << 20},
        "bits_per_voxel": {"svdag_paper": 0.42, "svo_pointerless": 2}, "dag_nodes_per_level": [1, 8, 20],
        "svo_nodes_per_level": [1, 8, 60]}))
    return found(SVDAG, "Lucy", state), {**{name: [] for name in svdag_runs.SERIES}, "dags": [build]}


class Svdag(unittest.TestCase):
    def test_a_variant_stands_beside_the_paper(self):
        text = text_of(svdag.table2_section([lucy("variant")]))
        for row in ("| Lucy (variant) | DAG | 1.5 |", "|  | DAG, published | 1 |", "| Lucy (variant) | DAG | 4 |",
                    "|  | SVO | 20 |", "| 2K³ | 80.0 M | 0.42 | 2.00 | 64K³ | 1.54 | 2.57 |"):
            self.assertIn(row, text)

    def test_a_stand_in_does_not_stand_beside_the_paper(self):
        text = text_of(svdag.table2_section([lucy("stand-in")]))
        self.assertIn("| Lucy (stand-in) | DAG | 1.5 |", text)
        self.assertNotIn("published |", text)

    def test_an_esvo_that_was_not_built_is_a_dash_and_a_reason(self):
        scene, series = lucy("stand-in")
        series["esvos"] = [failed("needs 9 GiB", 11)]
        text = text_of(svdag.table2_section([(scene, series)]))
        self.assertIn("|  | ESVO | – |", text)
        self.assertIn("Lucy at 2K³: needs 9 GiB.", text)

    def test_figure_5_has_a_line_for_each_dag_and_one_for_the_octree(self):
        (chart,) = svdag.figure5_charts([lucy("same")])
        dag, svo = chart["panels"][0]["lines"]
        self.assertEqual((dag["label"], dag["y"]), ("DAG 2K³", [1, 8, 20]))
        self.assertEqual(svo["label"], "SVO")
        self.assertEqual(svdag.figure5_charts([]), [])

    def test_claims_look_at_the_papers_scenes_only(self):
        variant = text_of(svdag.claims_section([lucy("variant")], None))
        self.assertIn("| 576 at 64K³ | 13 (Lucy at 2K³) | not measured at 64K³ |", variant)
        self.assertIn("| 28 to 576 at the highest resolutions | 13 (Lucy at 2K³) | reproduced |", variant)
        self.assertIn("| 576 at 64K³ | – | not measured |", text_of(svdag.claims_section([lucy("stand-in")], None)))


def rows_of(rays, rival, rival_rate):
    """Returns rows of `bench trace` for two frames: voxdag's rates with those of a rival."""
    return {"rays": rays, "mrays_per_s": 20, "view_mrays_per_s": [10, 30], "rival": rival, "rival_mrays_per_s": rival_rate,
            "rival_view_mrays_per_s": [rival_rate, rival_rate], "rival_agreement": 0.995}


class Flight(unittest.TestCase):
    def flight(self, levels, *rows):
        """Returns Lucy, and a flight in which only the run with triangles was measured."""
        runs = {name: FlightRun(0, Cell([]), Result("no memory"))
                for name in ("with_esvo", "with_voxels", "with_cones", "with_lamps")}
        return lucy("variant")[0], {**runs, "with_triangles": FlightRun(levels, Cell([]), Result(json=list(rows)))}

    def test_the_faster_of_a_rivals_casts_stands_beside_the_dag(self):
        scene, runs = self.flight(15, rows_of("shadow", "embree_single", 10), rows_of("shadow", "embree_packet16", 40))
        text = text_of(*flight.flight_sections(Plan(), scene, runs, False))
        self.assertIn("**Shadow rays, Lucy (variant) at 32K³**", text)
        self.assertIn("| triangles (Embree, on the processor) | 40 | 0.5 | 99.5 % |", text)
        self.assertIn("Not measured: no memory.", text)
        charts = flight.flight_charts(scene, runs)
        self.assertEqual(len(charts), 4)
        shadow = charts[1]["panels"][0]["lines"]
        self.assertEqual(shadow[0]["y"], [100, 1000 / 30])  # ms for a million rays
        self.assertEqual(shadow[2]["y"], [25, 25])

    def test_embree_compares_with_the_dag_on_the_processor(self):
        scene, runs = self.flight(0, rows_of("shadow", "embree_single", 10), rows_of("shadow", "voxdag_cpu", 2))
        text = text_of(*flight.flight_sections(Plan(), scene, runs, False))
        self.assertIn("| DAG, on the processor | 2 | 10 |", text)
        self.assertIn("| triangles (Embree, on the processor) | 10 | 0.2 |", text)
        self.assertEqual(flight.speed_ratio(runs["with_triangles"], "shadow", "embree"), 0.2)


def sibenik(state):
    """Returns Sibenik in this state, with octrees of 13 and 14 levels; the paper's has 14."""
    runs = esvo_runs.SceneRuns(found(ESVO, "Sibenik", state))
    rates = {form: {"mrays_per_s": rate, "cpu_mrays_per_s": None}
             for form, rate in (("triangles", 40), ("cubes", 25), ("contours", 50), ("contours_beams", 55))}
    rays = {"width": 1024, "height": 768, "ray_count": 1_000_000, "picture_seconds": 0.05, "filter_seconds": 0.002, **rates}
    for levels in (13, 14):
        runs.builds.append(Run(levels, Cell([]), Result(json={
            "bytes": {"esvo": 60 << 20}, "voxels": 10 << 20, "seconds": {"build": 7.5}})))
        runs.rays.append(Run(levels, Cell([]), Result(json={
            "rays": [rays], "silhouettes": [{"cubes_wrong": 8e-4 / (levels - 12), "contours_wrong": 5e-5}]})))
    return runs


def picture_of(kind, failure=""):
    cell = Cell(["render", "picture.esvo", "--filter-kind", kind, "-o", kind + ".png"], output=kind + ".png")
    return ScenePicture(None, cell, Result(failure))


class Esvo(unittest.TestCase):
    def test_a_variant_stands_beside_the_paper_at_equal_depth(self):
        scenes = [sibenik("variant")]
        table1, table2 = text_of(esvo.table1_section(scenes, 2)), text_of(esvo.table2_section(scenes))
        self.assertIn("| Sibenik (variant) | MB | 60 | 60 |", table1)
        self.assertIn("|  | MB, published | 1,034 | 1,857 |", table1)
        self.assertIn("| 16K³ | 10.5 M | 6.00 | 16K³ | 5.68 |", table1)
        self.assertIn("| 16K³ | 1024 × 768 | 40 (94) | 25 (46) | 50 (94) | 55 (104) |", table2)
        self.assertNotIn("| 8K³ |", table2)

    def test_rates_of_another_depth_stand_alone(self):
        runs = sibenik("variant")
        runs.rays.pop()
        self.assertIn("| 8K³ | 1024 × 768 | 40 | 25 | 50 | 55 |", text_of(esvo.table2_section([runs])))

    def test_a_stand_in_does_not_stand_beside_the_paper(self):
        scenes = [sibenik("stand-in")]
        self.assertNotIn("MB, published", text_of(esvo.table1_section(scenes, 2)))
        self.assertIn("| 16K³ | 1024 × 768 | 40 | 25 | 50 | 55 |", text_of(esvo.table2_section(scenes)))
        self.assertIn("| 1.1 to 2.7 | – | not measured |", text_of(esvo.claims_section(scenes)))

    def test_filter_and_shading_stand_beside_the_casts(self):
        # A million rays at 55 million per second take 18 ms.
        self.assertIn("| 1024 × 768 | 18 ms | 50 ms | 2 ms | 9.1 |", text_of(esvo.table2_section([sibenik("variant")])))

    def test_claims_are_judged_by_the_finest_octrees(self):
        text = text_of(esvo.claims_section([sibenik("variant")]))
        for row in ("| 5.2 to 8.1 | 6 (Sibenik at 16K³) | reproduced |",
                    "| 1.1 to 2.7 | 2 (Sibenik at 16K³, 1024 × 768) | reproduced |",
                    "| 10 to 100 | 9.1 (Sibenik at 16K³, 1024 × 768) | not reproduced |"):
            self.assertIn(row, text)

    def test_levels_are_saved_beside_cubes_of_the_same_grid_and_finer_ones(self):
        def saved(row, *values):
            rows = [esvo_runs.Silhouettes(10 + i, *both) for i, both in enumerate(values)]
            levels, is_least = esvo_runs.levels_saved(rows, rows[row])
            return round(levels, 9), is_least
        usual = (8e-4, 1e-4), (4e-4, 5e-5), (2e-4, 2e-5), (1e-4, 1e-5)
        self.assertEqual([saved(row, *usual) for row in (0, 1, 3)], [(3, False), (2, True), (0, True)])
        # In a closed room hardly any ray misses: coarser cubes may have no wrong rays by chance.
        room = (0, 0), (7e-5, 9e-6), (0, 0)
        self.assertEqual([saved(row, *room) for row in range(3)], [(0, True), (1, False), (0, True)])
        # Contours that are worse than the cubes of their grid.
        self.assertEqual(saved(1, (4e-4, 9e-4), (2e-4, 4e-4)), (-1, False))

    def test_filters_stand_side_by_side(self):
        pictures = {"filters": [picture_of("naive"), picture_of("plain")],
                    "guides": [picture_of("plain"), picture_of("guided")]}
        figure10, figure11 = map(text_of, esvo.picture_sections(pictures))
        for part in ("Figure 10: ", "naive.png", "plain.png",
                     "voxdag render picture.esvo --filter-kind plain -o plain.png"):
            self.assertIn(part, figure10)
        for part in ("Figure 11: ", "plain.png", "guided.png",
                     "voxdag render picture.esvo --filter-kind guided -o guided.png"):
            self.assertIn(part, figure11)
        pictures["guides"][0] = picture_of("plain", "took too long")
        self.assertIn("No picture: took too long.", text_of(esvo.picture_sections(pictures)[1]))

    def test_charts_have_a_line_for_each_form_and_resolution(self):
        scenes = [sibenik("variant")]
        (rates,), (memory,), (errors,) = map(lambda make: make(scenes), (
            esvo.table2_charts, esvo.table1_charts, esvo.silhouettes_charts))
        self.assertEqual(len(rates["panels"][0]["lines"]), 4)
        self.assertEqual(rates["panels"][0]["lines"][0]["x"], [8192, 16384])
        self.assertEqual(memory["panels"][0]["lines"][1]["style"], "dashed")
        self.assertEqual(errors["panels"][0]["lines"][1]["y"], [800, 400])
        self.assertEqual(esvo.table2_charts([]), [])


if __name__ == "__main__":
    unittest.main()
