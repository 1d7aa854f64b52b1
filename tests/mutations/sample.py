# SPDX-License-Identifier: Apache-2.0
"""Draws small mistakes in the sources from a seed, makes them one at a time in a copy, and records
which test notices. tests/mutations/README.md explains how to read the result; sample.sh runs it."""
import argparse
import filecmp
import hashlib
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path
from typing import NamedTuple

from sites import Site, sites_of

HERE = Path(__file__).resolve().parent
SOURCES = ('slam', 'bench', 'sim/sensors')
PASSED_OVER = ('bench/lab/micro/',)
# Each kind is drawn in turn; 'logic' counts as 'relation'.
KINDS = ('relation', 'arithmetic', 'constant', 'arguments', 'statement')
KIND_OF = {'logic': 'relation'}
LONGEST_TEST_S, LEAST_LIMIT_S, TIMES_SLOWER = 600, 60, 3
MOST_COMPARED = 12  # object files
MOST_MEMORY = 8 << 30  # bytes, for a test
EQUAL, CAUGHT, SURVIVED, NO_MUTANT = 'equal', 'caught', 'survived', 'does not compile'


class Mutant(NamedTuple):
    id: str
    kind: str
    file: str
    line: int
    text: str  # the line
    site: Site

    def change(self):
        def short(part):
            return ' '.join(part.split())[:60]
        return f'{short(self.site.old)} -> {short(self.site.new) or "nothing"}'


def rank(*parts):
    return hashlib.sha256('\0'.join(map(str, parts)).encode()).hexdigest()


def mutants_of(tree, name):
    """By kind, then by line: (key of the line, its mutants). The keys contain no line numbers, so that
    a change elsewhere has no effect on them."""
    content = (tree / name).read_text()
    seen, lines = Counter(), {}
    for number, text in enumerate(content.split('\n'), 1):
        seen[text.strip()] += 1
        lines[number] = (text.strip(), seen[text.strip()])
    found = {}
    for site in sites_of(content, name.endswith('.hpp')):
        number = content.count('\n', 0, site.at) + 1
        text, nth = lines[number]
        column = site.at - content.rfind('\n', 0, site.at)
        kind = KIND_OF.get(site.kind, site.kind)
        mutant = Mutant(rank(name, text, nth, column, site.kind, site.new)[:12], kind, name, number,
                        text, site)
        found.setdefault(kind, {}).setdefault((name, text, nth), []).append(mutant)
    return found


def draw(tree, seed, folders):
    """{kind: its mutants in the order in which the seed tries them}. The seed orders the lines of a kind. One
    mutant of each line comes first; the other mutants follow after all lines."""
    names = subprocess.run(['git', '-C', tree, 'ls-files', *folders], check=True, text=True,
                           capture_output=True).stdout.split()
    by_kind = {kind: [] for kind in KINDS}
    for name in names:
        if not name.endswith(('.cpp', '.hpp')) or name.startswith(PASSED_OVER):
            continue
        for kind, of_line in mutants_of(tree, name).items():
            for key, mutants in of_line.items():
                mutants.sort(key=lambda m: rank(seed, m.id))
                by_kind[kind] += [((turn, rank(seed, kind, *key)), mutant)
                                  for turn, mutant in enumerate(mutants)]
    for pairs in by_kind.values():
        pairs.sort(key=lambda pair: pair[0])
    return {kind: [mutant for _, mutant in pairs] for kind, pairs in by_kind.items()}


class Results:
    """Verdicts, one line per mutant; a later line replaces an earlier one."""
    COLUMNS = ('verdict', 'kind', 'id', 'place', 'change', 'by', 'commit')

    def __init__(self, file):
        self.file, self.rows = Path(file), {}
        if self.file.exists():
            for line in self.file.read_text().splitlines():
                if line and not line.startswith('#'):
                    row = dict(zip(self.COLUMNS, line.split('\t')))
                    self.rows[row['id']] = row

    def add(self, head, **row):
        if not self.file.exists():
            self.file.write_text(head + '# ' + '\t'.join(self.COLUMNS) + '\n')
        with self.file.open('a') as out:
            out.write('\t'.join(row[c].replace('\t', ' ') for c in self.COLUMNS) + '\n')
        self.rows[row['id']] = row

    def of(self, *verdicts):
        return [row for row in self.rows.values() if row['verdict'] in verdicts]

    def summary(self):
        caught, survivors = len(self.of(CAUGHT)), self.of(SURVIVED)
        tried = caught + len(survivors)
        share = 100 * caught / tried if tried else 0
        lines = [f'  {r["place"]}: {r["kind"]}: {r["change"]}' for r in survivors]
        return '\n'.join([f'caught {caught} of {tried} ({share:.1f} %), equal '
                          f'{len(self.of(EQUAL))}, survivors listed' + (':' if lines else ''),
                          *lines])


class Copy:
    """A separate worktree, built like the project."""

    def __init__(self, root, work, jobs, commit, folders):
        self.tree, self.build, self.jobs = work / 'tree', work / 'tree/build/release', jobs
        self.log = work / 'log'
        self.head = subprocess.run(['git', '-C', root, 'rev-parse', commit], check=True, text=True,
                                   capture_output=True).stdout.strip()
        if not self.tree.exists():
            work.mkdir(parents=True, exist_ok=True)
            subprocess.run(['git', '-C', root, 'worktree', 'prune'], check=True)
            self.run('git', '-C', root, 'worktree', 'add', '--quiet', '--detach', self.tree, self.head)
        self.run('git', '-C', self.tree, 'checkout', '--quiet', '--force', '--detach', self.head)
        # Changed files are compiled separately: an object file then belongs to one source and is built quickly.
        # Properties of a source apply in one folder of the build, which must already be known.
        alone = work / 'alone.cmake'
        globs = ' '.join(f'{self.tree / folder}/*.cpp' for folder in (*folders, 'tests'))
        alone.write_text(f'file(GLOB_RECURSE ALONE {globs})\n'
                         'function(compile_alone folder)\n'
                         '  set_source_files_properties(${ALONE} DIRECTORY ${folder} PROPERTIES\n'
                         '    SKIP_UNITY_BUILD_INCLUSION ON)\n'
                         '  get_property(below DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)\n'
                         '  foreach(one IN LISTS below)\n'
                         '    compile_alone(${one})\n'
                         '  endforeach()\n'
                         'endfunction()\n'
                         'cmake_language(DEFER DIRECTORY ${CMAKE_SOURCE_DIR} CALL compile_alone\n'
                         '               ${CMAKE_SOURCE_DIR})\n')
        if not (self.build / 'build.ninja').exists():
            # With assertions in the library's containers, an index past the end ends the program.
            self.run('cmake', '--preset', 'release', '-DCMAKE_CXX_FLAGS=-D_GLIBCXX_ASSERTIONS',
                     f'-DCMAKE_PROJECT_INCLUDE={alone}', cwd=self.tree)
        self.ninja('build.ninja')
        targets = subprocess.run(['ninja', '-C', self.build, '-t', 'targets', 'all'], check=True,
                                 text=True, capture_output=True).stdout
        self.tests = {}
        for name in sorted(set(re.findall(r'^(test_\w+): CXX_EXECUTABLE', targets, re.M))):
            inputs = subprocess.run(['ninja', '-C', self.build, '-t', 'inputs', name], check=True,
                                    text=True, capture_output=True).stdout.split()
            self.tests[name] = {os.path.relpath(i, self.tree) for i in inputs
                                if i.startswith(str(self.tree))}
        self.objects = self.read_objects()

    def read_objects(self):
        commands = json.loads((self.build / 'compile_commands.json').read_text())
        found = {}
        for c in commands:
            match = re.search(r' -o (\S+\.o) ', c['command'])
            if match:
                found.setdefault(os.path.relpath(c['file'], self.tree), []).append(match[1])
        return found

    def run(self, *command, cwd=None):
        with self.log.open('wb') as out:
            status = subprocess.run(list(map(str, command)), cwd=cwd, stdout=out,
                                    stderr=subprocess.STDOUT).returncode
        if status != 0:
            sys.exit(f'{" ".join(map(str, command))}: exit code {status}\n'
                     + self.log.read_text(errors='replace')[-2000:])

    def ninja(self, *targets):
        with self.log.open('wb') as out:
            return subprocess.run(['ninja', '-C', self.build, '-j', str(self.jobs), *targets],
                                  stdout=out, stderr=subprocess.STDOUT).returncode == 0

    def objects_of(self, name):
        """Object files that depend on a source: its own, or for a header, those of all that include it."""
        if name.endswith('.cpp'):
            return self.objects.get(name, [])
        deps = subprocess.run(['ninja', '-C', self.build, '-t', 'deps'], check=True, text=True,
                              capture_output=True).stdout
        wanted, found, current = os.path.normpath(self.tree / name), [], None
        for line in deps.splitlines():
            if line and not line[0].isspace():
                current = line.split(':')[0]
            elif os.path.normpath(self.build / line.strip()) == wanted:
                found.append(current)
        return found

    def tests_of(self, name, objects):
        """The executables that contain one of the objects; all executables if none is known to contain one."""
        sources = {s for s, os_ in self.objects.items() if set(os_) & set(objects)} | {name}
        return [t for t, inputs in self.tests.items() if inputs & sources] or list(self.tests)


class Experience:
    """What earlier mutants showed about the tests: how long they take, and where they catch mistakes."""

    def __init__(self, file):
        self.file = file
        known = json.loads(file.read_text()) if file.exists() else {}
        self.passed_s, self.catches = known.get('passed_s', {}), known.get('catches', {})

    def save(self):
        self.file.write_text(json.dumps({'passed_s': self.passed_s, 'catches': self.catches}))

    def limit_s(self, test):
        if test not in self.passed_s:
            return LONGEST_TEST_S
        return min(LONGEST_TEST_S, max(LEAST_LIMIT_S, TIMES_SLOWER * self.passed_s[test]))

    def likeliest_first(self, copy, tests, name):
        """Sorts tests: first those in the same folder, those that include the file's header or one next to
        it, and those that caught something there; among equals, quicker tests come first."""
        folder, header = os.path.dirname(name), str(Path(name).with_suffix('.hpp'))

        def nearness(source):
            common = os.path.commonprefix([Path(source).parts[1:-1], Path(name).parts[:-1]])
            included = set(re.findall(r'#include "([^"]+)"', (copy.tree / source).read_text()))
            return (len(common) + 8 * (header in included)
                    + 4 * any(os.path.dirname(i) == folder for i in included))

        def key(test):
            caught = self.catches.get(test, {})
            likely = 3 * caught.get(name, 0) + caught.get(folder, 0) + max(
                [nearness(source) for source in copy.tests[test] if source.startswith('tests/')],
                default=0)
            return -likely / (1 + self.passed_s.get(test, 20) / 20), len(copy.tests[test]), test
        return sorted(tests, key=key)


def bound(limit_s):
    """Sets limits: a mistake may request all memory, write forever, or compute forever."""
    for what, most in ((resource.RLIMIT_DATA, MOST_MEMORY), (resource.RLIMIT_FSIZE, MOST_MEMORY),
                       (resource.RLIMIT_CORE, 0), (resource.RLIMIT_CPU, int(limit_s) + 1)):
        resource.setrlimit(what, (most, most))


def outcome(copy, test, limit_s):
    """'' if the test passes, otherwise what failed; and the processor seconds that the test took, which do
    not depend on other load. A wall-clock limit ends tests that wait forever."""
    with copy.log.open('wb') as out:
        process = subprocess.Popen(
            [copy.build / test, '--gtest_brief=1', '--gtest_fail_fast'], cwd=copy.tree, stdout=out,
            stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, start_new_session=True,
            preexec_fn=lambda: bound(limit_s))
        waits = threading.Timer(2 * LONGEST_TEST_S, os.killpg, (process.pid, signal.SIGKILL))
        waits.start()
        _, status, usage = os.wait4(process.pid, 0)
        waits.cancel()
        process.returncode = status = os.waitstatus_to_exitcode(status)
    took = usage.ru_utime + usage.ru_stime
    failed = re.search(r'^\[  FAILED  \] ([^\s,]+)', copy.log.read_text(errors='replace'), re.M)
    if status == -signal.SIGKILL and not failed:
        return 'timed out', took
    return ('' if status == 0 else failed[1] if failed else f'ended with {status}'), took


def judge(copy, mutant, experience, most_tests):
    """The verdict and the test that noticed. The copy's sources are restored."""
    file = copy.tree / mutant.file
    content = file.read_text()
    objects = copy.objects_of(mutant.file)
    # For a header that half of the project includes, no object files are compared: each test's
    # build compiles what the test needs.
    compared = objects if len(objects) <= MOST_COMPARED else []
    if compared and not copy.ninja(*compared):
        sys.exit(f'{mutant.file}: does not build as it is:\n{copy.log.read_text()[-2000:]}')
    kept = copy.build / 'unchanged'
    shutil.rmtree(kept, ignore_errors=True)
    for o in compared:
        (kept / o).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(copy.build / o, kept / o)
    site = mutant.site
    changed = content[:site.at] + site.new + content[site.at + len(site.old):]
    try:
        file.write_text(changed)
        if compared and not copy.ninja(*compared):
            return NO_MUTANT, ''
        if compared and all(filecmp.cmp(copy.build / o, kept / o, shallow=False)
                            for o in compared):
            return EQUAL, 'the same object code'
        tests = experience.likeliest_first(copy, copy.tests_of(mutant.file, objects), mutant.file)
        for test in tests[:most_tests]:
            if not copy.ninja(test):
                if 'error:' in copy.log.read_text(errors='replace'):
                    return NO_MUTANT, ''
                sys.exit(f'{test} does not link:\n{copy.log.read_text()[-2000:]}')
            failure, took = outcome(copy, test, experience.limit_s(test))
            if failure and test not in experience.passed_s:
                file.write_text(content)  # does the test pass without the mistake?
                copy.ninja(test)
                itself, took = outcome(copy, test, LONGEST_TEST_S)
                if itself:
                    sys.exit(f'{test} fails without any mistake: {itself}')
                experience.passed_s[test] = took
            if failure:
                of_test = experience.catches.setdefault(test, {})
                for place in (mutant.file, os.path.dirname(mutant.file)):
                    of_test[place] = of_test.get(place, 0) + 1
                return CAUGHT, f'{test}: {failure}'
            experience.passed_s[test] = max(took, experience.passed_s.get(test, 0))
        return SURVIVED, ', '.join(tests[:most_tests])
    finally:
        file.write_text(content)
        experience.save()


def arguments():
    parser = argparse.ArgumentParser(prog='tests/mutations/sample.sh', description=__doc__)
    parser.add_argument('--count', type=int, default=200,
                        help='mutants that compile and are not equal, in all (default 200)')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--only', nargs='+', default=SOURCES, metavar='FOLDER',
                        help=f'draws from these folders (default {" ".join(SOURCES)})')
    parser.add_argument('--results', type=Path, help='default: tests/mutations/sample_seedS.tsv')
    parser.add_argument('--work', type=Path, help='keeps the copy of the sources here')
    parser.add_argument('--commit', default='HEAD', help='whose sources and tests (default HEAD)')
    parser.add_argument('--jobs', type=int, default=os.cpu_count(), help='compiler processes')
    parser.add_argument('--minutes', type=float, default=float('inf'),
                        help='begins no mutant after that')
    parser.add_argument('--tests', type=int, metavar='N',
                        help='runs the N likeliest test executables alone (default: all); what '
                        'survives them may not survive the others')
    parser.add_argument('--again', action='store_true',
                        help='tries the survivors of the results once more, and no others')
    parser.add_argument('--list', action='store_true', help='prints what would be tried, in order')
    return parser.parse_args()


def main():
    args = arguments()
    began = time.monotonic()
    root = Path(subprocess.run(['git', '-C', HERE, 'rev-parse', '--show-toplevel'], check=True,
                               text=True, capture_output=True).stdout.strip())
    if args.list:
        order = draw(root, args.seed, args.only)
        for turn in range(args.count):
            of_kind = order[KINDS[turn % len(KINDS)]]
            if turn // len(KINDS) < len(of_kind):
                mutant = of_kind[turn // len(KINDS)]
                print(f'{mutant.file}:{mutant.line}: {mutant.kind}: {mutant.change()}')
        return 0
    work = args.work or Path(os.environ.get('TMPDIR', '/tmp')) / f'modelhouse-sample-{os.getuid()}'
    results = Results(args.results or HERE / f'sample_seed{args.seed}.tsv')
    os.environ.setdefault('CCACHE_BASEDIR', str(work.resolve()))
    os.environ['CCACHE_NOHASHDIR'] = '1'
    copy = Copy(root, work.resolve(), args.jobs, args.commit, args.only)
    experience = Experience(work / 'experience.json')
    order = draw(copy.tree, args.seed, args.only)
    only = f' --only {" ".join(args.only)}' if args.only != SOURCES else ''
    head = (f'# tests/mutations/sample.sh --count {args.count} --seed {args.seed}{only}\n'
            '# A later line of one id counts in the place of an earlier one.\n')

    def try_out(mutant):
        verdict, by = judge(copy, mutant, experience, args.tests)
        results.add(head, verdict=verdict, kind=mutant.kind, id=mutant.id,
                    place=f'{mutant.file}:{mutant.line}', change=mutant.change(), by=by,
                    commit=copy.head[:7])
        print(f'{verdict}: {mutant.file}:{mutant.line}: {mutant.change()}'
              + (f': {by}' if by else ''), flush=True)

    def out_of_time():
        return time.monotonic() - began > 60 * args.minutes

    if args.again:
        survivors = {row['id'] for row in results.of(SURVIVED)}
        for mutant in (m for of_kind in order.values() for m in of_kind):
            if mutant.id in survivors and not out_of_time():
                try_out(mutant)
    else:
        # The kinds take turns; each gets its share of the count.
        for share in range(1, (args.count + len(KINDS) - 1) // len(KINDS) + 1):
            for kind in KINDS:
                while (len([r for r in results.of(CAUGHT, SURVIVED) if r['kind'] == kind]) < share
                       and len(results.of(CAUGHT, SURVIVED)) < args.count and not out_of_time()):
                    mutant = next((m for m in order[kind] if m.id not in results.rows), None)
                    if mutant is None:
                        break
                    try_out(mutant)
    print(results.summary())
    return 0


if __name__ == '__main__':
    sys.exit(main())
