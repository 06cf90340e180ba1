#!/usr/bin/env python3
"""Tests how measurements are run, kept and shared."""

import os
import pathlib
import tempfile
import time
import unittest
from concurrent.futures import ThreadPoolExecutor

import report_path  # noqa: F401

from cells import Cell, CellStore, build_series
from child import Program, ScratchFolder, run_child
from commands import image_size, level, levels, memory
from document import Error
from papers import Plan, RankFile, Sharing, run_items
from png import read_first_channel, write_grey
from scenes import FoundScene
from text import NAN, human_bytes, human_count, human_duration, number_text, seconds_text, short_resolution

# Counts its runs in the file "runs", writes its last argument if that is a path, and prints JSON.
PROGRAM = """#!/bin/sh
echo "$*" >>"$(dirname "$0")/runs"
for last; do :; done
case $last in /*) echo written >"$last";; fail) echo "voxdag: it failed" >&2; exit 3;; esac
echo '{"ok": 1}'
"""


class Cells(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        program = self.path("program")
        pathlib.Path(program).write_text(PROGRAM, encoding="utf-8")
        os.chmod(program, 0o700)
        self.program = Program(program, "voxdag 1")
        os.mkdir(self.path("scratch"))

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def store(self, program=None, scratch="scratch"):
        return CellStore(self.path("cells"), self.path(scratch), program or self.program)

    def runs(self):
        return pathlib.Path(self.path("runs")).read_text(encoding="utf-8").splitlines()

    def test_a_result_is_kept_for_the_next_report(self):
        first = self.store()
        self.assertEqual(first.run(Cell(["a"])).json, {"ok": 1})
        self.assertEqual((first.measured, first.kept), (1, 0))
        again = self.store()
        self.assertEqual(again.run(Cell(["a"])).json, {"ok": 1})
        self.assertEqual((again.measured, again.kept), (0, 1))
        self.assertEqual(self.runs(), ["a"])

    def test_a_failure_is_a_result_and_is_kept(self):
        for _ in range(2):
            self.assertEqual(self.store().run(Cell(["fail"])).failure, "it failed")
        self.assertEqual(len(self.runs()), 1)

    def test_another_program_argument_device_input_or_limit_is_another_cell(self):
        store = self.store()
        store.contents["in"] = "1"
        store.run(Cell(["a", "in"], ["in"]))
        store.run(Cell(["b", "in"], ["in"]))
        store.run(Cell(["a", "in"], ["in"], device="H100"))
        store.run(Cell(["a", "in"], ["in"], limit=5))
        store.contents["in"] = "2"
        store.run(Cell(["a", "in"], ["in"]))
        self.assertEqual(store.measured, 5)
        other = self.store(Program(self.program.path, "voxdag 2"))
        other.contents["in"] = "2"
        other.run(Cell(["a", "in"], ["in"]))
        self.assertEqual(other.measured, 1)

    def test_an_output_that_changed_is_made_again(self):
        cell = Cell(["paint", self.path("out.png")], output=self.path("out.png"), keeps_output=True)
        self.store().run(cell)
        pathlib.Path(self.path("out.png")).write_text("other", encoding="utf-8")
        store = self.store()
        store.run(cell)
        self.assertEqual((store.measured, store.kept), (1, 0))

    def test_an_input_that_was_removed_is_made_again_and_counts_as_kept(self):
        voxels = self.path("scratch/a.vdag")
        for arguments, ran in ((["one"], 2), (["two"], 1)):
            store = self.store()
            store.run(Cell(["build", voxels], output=voxels))
            store.run(Cell(arguments + [voxels, "-"], [voxels]))
            self.assertEqual(store.measured, ran)
            os.remove(voxels)
        self.assertEqual([run.split()[0] for run in self.runs()], ["build", "one", "build", "two"])

    def test_a_series_stops_at_a_failure(self):
        store = self.store()
        store.contents["/m.obj"] = "1"
        runs = build_series(Plan(cell_seconds=1e-9), "hash", FoundScene(None, mesh="/m.obj"), [9, 10, 11], store)
        reason = "not run, because 512³ failed: stopped at the time limit of 1e-09 s"
        self.assertEqual([run.result.failure for run in runs], [reason[30:], reason, reason])

    def test_a_command_names_files_without_their_folders(self):
        cell = Cell(["bench", "esvo", "A=/x/a.obj --bake-ao", "-o", "/y/b.esvo"], ["/x/a.obj"], "/y/b.esvo")
        self.assertEqual(cell.command(), "voxdag bench esvo 'A=a.obj --bake-ao' -o b.esvo")

    def test_ranks_share_the_items(self):
        def rank(number):
            os.mkdir(self.path(f"scratch{number}"))
            store = self.store(scratch=f"scratch{number}")
            items = {i: lambda i=i: store.run(Cell([f"item{i}"])) for i in range(5)}
            return store, run_items(items, store, Sharing(number, 2, 2))
        with ThreadPoolExecutor() as both:
            first = both.submit(rank, 0)
            time.sleep(0.3)  # rank 0 has to wait
            self.assertEqual(both.submit(rank, 1).result()[1], {})
            store, results = first.result()
        self.assertEqual([result.json for result in results.values()], 5 * [{"ok": 1}])
        self.assertEqual(sorted(self.runs()), [f"item{i}" for i in range(5)])
        self.assertEqual((store.measured, store.kept), (5, 0))

    def test_rank_0_does_not_wait_for_a_rank_that_failed_or_has_another_machine(self):
        store = self.store()
        store.is_mine = False
        with self.assertRaisesRegex(ValueError, "gone"), RankFile(Sharing(1, 2), store, ""):
            raise ValueError("gone")
        with self.assertRaisesRegex(Error, "rank 1 has \"failed: gone\""), RankFile(Sharing(0, 2), store, ""):
            store.run(Cell(["never"]))
        with RankFile(Sharing(1, 2), store, "H100"), self.assertRaisesRegex(Error, "machines of one kind"), RankFile(
                Sharing(0, 2), store, "A100"):
            store.run(Cell(["never"]))
        self.assertEqual([name for name in os.listdir(store.folder) if name.startswith("job")], [])

    def test_mpirun_and_srun_tell_the_rank(self):
        self.assertEqual(Sharing.of({}), Sharing(0, 1, 1))
        self.assertEqual(Sharing.of({"OMPI_COMM_WORLD_RANK": "2", "OMPI_COMM_WORLD_SIZE": "4",
                                     "OMPI_COMM_WORLD_LOCAL_SIZE": "2", "PMIX_NAMESPACE": "prte-1@1"}),
                         Sharing(2, 4, 2, "prte-1-1"))
        self.assertEqual(Sharing.of({"PMI_RANK": "1", "PMI_SIZE": "3", "MPI_LOCALNRANKS": "3"}), Sharing(1, 3, 3))
        self.assertEqual(Sharing.of({"SLURM_PROCID": "0", "SLURM_STEP_NUM_TASKS": "7",
                                     "SLURM_STEP_TASKS_PER_NODE": "2(x3),1"}), Sharing(0, 7, 2))
        # A batch script without srun is one process, whatever the number of tasks that it asked for.
        self.assertEqual(Sharing.of({"SLURM_PROCID": "0", "SLURM_NTASKS": "7"}), Sharing(0, 1, 1))


class Children(unittest.TestCase):
    def test_their_cost_and_the_reason_of_a_failure_are_known(self):
        child = run_child(["sh", "-c", "echo out; echo 'voxdag: wrong' >&2; exit 3"], "/")
        self.assertEqual((child.status, child.out, child.failure(0)), (3, "out\n", "wrong"))
        self.assertGreater(child.cost["peak_memory_bytes"], 0)
        self.assertEqual(run_child(["sh", "-c", "kill -9 $$"], "/").failure(0), "killed by signal 9")

    def test_a_child_and_its_children_end_at_the_limit(self):
        start = time.monotonic()
        child = run_child(["sh", "-c", "sleep 60 & wait"], "/", 0.2)
        self.assertEqual(child.failure(0.2), "stopped at the time limit of 0.2 s")
        self.assertLess(time.monotonic() - start, 30)

    def test_a_scratch_folder_is_removed_with_its_contents(self):
        with ScratchFolder() as scratch:
            pathlib.Path(scratch.path, "a").write_text("a", encoding="utf-8")
        self.assertFalse(os.path.exists(scratch.path))


class Texts(unittest.TestCase):
    def test_numbers_have_the_digits_that_count(self):
        self.assertEqual([number_text(x) for x in (NAN, 0.0338, 1.23, 27.4, 13168.7)], ["–", "0.034", "1.2", "27", "13,169"])
        self.assertEqual([seconds_text(x) for x in (NAN, 0.0084, 1.2, 95)], ["–", "8.4 ms", "1.20 s", "95 s"])
        self.assertEqual([human_count(x) for x in (999.6, 12.3e6)], ["1.00 k", "12.3 M"])
        self.assertEqual(human_bytes(12.3 * 2**20), "12.3 MiB")
        self.assertEqual([human_duration(x) for x in (40, 720, 12000)], ["40 s", "12 min", "3 h 20 min"])
        self.assertEqual([short_resolution(x) for x in (9, 12)], ["512³", "4K³"])

    def test_options_are_parsed_as_voxdag_parses_them(self):
        self.assertEqual((level("4K"), levels("64,1k,64"), memory("1.5GiB"), image_size("40x32")),
                         (12, [6, 10], 3 << 29, (40, 32)))
        for parse, text, reason in ((level, "63", "63 is not a power of two from 4 to 1048576; the nearest are 32 and 64"),
                                    (level, "2", "the nearest is 4"), (memory, "5X", "is not an amount of memory"),
                                    (image_size, "40", "must be WIDTHxHEIGHT")):
            with self.assertRaisesRegex(Exception, reason):
                parse(text)

    def test_pictures_are_read_as_they_were_written(self):
        rows = [bytes(x * y % 256 for x in range(40)) for y in range(20)]
        with tempfile.TemporaryDirectory() as folder:
            write_grey(folder + "/a.png", rows)
            self.assertEqual(read_first_channel(folder + "/a.png"), rows)


if __name__ == "__main__":
    unittest.main()
