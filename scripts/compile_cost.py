#!/usr/bin/env python3
"""Builds a folder that Ninja builds, and says what compiling it costs.

  scripts/compile_cost.py [--limit NAME] BUILD_FOLDER [ninja's option...]

prints the processor seconds of the build, and the wall-clock seconds of each target from Ninja's log.
With --limit it compares a build from scratch with a reference: a source that uses the standard library
only, compiled on the same machine right after. It fails if the build costs a third more references than
compile_cost.json says under NAME. Change that number if the build has a reason to cost more. The script
does not compare incremental builds.
"""
import argparse
import collections
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

REFERENCE = """
#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <regex>
#include <string>
#include <vector>
std::size_t count(const std::string& text, const std::string& word) {
  const std::regex regex(word);
  return std::distance(std::sregex_iterator(text.begin(), text.end(), regex), {});
}
template <class T> void shuffle_and_sort(std::map<T, std::vector<T>>& lists) {
  std::mt19937_64 random(1);
  for (auto& [key, list] : lists) {
    std::shuffle(list.begin(), list.end(), random);
    std::stable_sort(list.begin(), list.end(), std::greater<>());
  }
}
template void shuffle_and_sort(std::map<int, std::vector<int>>&);
template void shuffle_and_sort(std::map<std::string, std::vector<std::string>>&);
"""


def processor_seconds(commands, folder=None):
    """Runs commands at the same time; returns the user and system seconds of all their processes."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    running = [subprocess.Popen(command, cwd=folder) for command in commands]
    if any([process.wait() for process in running]):
        sys.exit(1)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def reference_seconds(compiler):
    """Returns what the reference costs, compiled on every processor at once as the build is: the least of three."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, 'reference.cpp').write_text(REFERENCE)
        command = [compiler, '-std=c++20', '-O3', '-c', 'reference.cpp', '-o', '/dev/null']
        count = os.cpu_count() or 1
        return min(processor_seconds([command] * count, folder) / count for _ in range(3))


def seconds_of_targets(log):
    """Returns {target: (objects, wall-clock seconds)} of the latest build of each object in Ninja's log."""
    objects = {}
    for line in log.read_text().splitlines():
        fields = line.split('\t')
        target = re.search(r'CMakeFiles/([^/]+)\.dir/', fields[3]) if len(fields) == 5 else None
        if target and fields[3].endswith('.o'):
            objects[fields[3]] = (target[1], (int(fields[1]) - int(fields[0])) / 1000)
    targets = collections.defaultdict(lambda: (0, 0.0))
    for target, seconds in objects.values():
        count, total = targets[target]
        targets[target] = (count + 1, total + seconds)
    return targets


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--limit', metavar='NAME')
    parser.add_argument('build', type=pathlib.Path)
    arguments, options = parser.parse_known_args()
    from_scratch = not (arguments.build / '.ninja_log').exists()
    seconds = processor_seconds([['cmake', '--build', arguments.build, '--', *options]])
    targets = seconds_of_targets(arguments.build / '.ninja_log')
    for target, (count, wall) in sorted(targets.items(), key=lambda item: -item[1][1]):
        print(f'  {wall:6.1f} s  {count:3} objects  {target}')
    print(f'The build took {seconds:.0f} processor seconds.')
    if not arguments.limit or not from_scratch:
        return
    cache = (arguments.build / 'CMakeCache.txt').read_text()
    reference = reference_seconds(re.search(r'^CMAKE_CXX_COMPILER:\w+=(.*)$', cache, re.MULTILINE)[1])
    known = json.loads(pathlib.Path(__file__).with_suffix('.json').read_text())[arguments.limit]
    cost = seconds / reference
    print(f'That is {cost:.0f} times the reference of {reference:.2f} s; compile_cost.json says {known}.')
    if cost > known * 4 / 3:
        sys.exit(f'Compiling costs a third more than scripts/compile_cost.json says for "{arguments.limit}".')


if __name__ == '__main__':
    main()
