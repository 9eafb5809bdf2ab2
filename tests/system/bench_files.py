"""Provides a folder with a log and a model for tests of the files that a command reads and writes."""

import resource
import shutil
import subprocess

import bench
import exit_codes

TWIN = "config/models/bench_twin.yaml"
# Largest address space of a process. A process of a build with a sanitizer needs terabytes, so this limit is not set
# there.
MEMORY_BYTES = 5 << 30


class Files(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.runner = exit_codes.Runner(self.folder)
        self.softgrip("simulate", "--model", TWIN, "--input", "steps", "--rate-hz", "20", "--noise-mm", "0.05", "--out", "log.csv")
        shutil.copy(self.folder / TWIN, self.folder / "model.yaml")

    def record(self):
        self.softgrip("run", "config/sequences/pick_stone.yaml", "--virtual-time", "--record", "rec", "--no-socket")

    def limited(self, *arguments, code):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
        sanitized = b"__asan_init" in bench.SOFTGRIP.read_bytes()
        done = subprocess.run([bench.SOFTGRIP, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=300 * bench.PATIENCE,
                              stdin=subprocess.DEVNULL, preexec_fn=None if sanitized else limit)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertNotIn("bad_alloc", done.stderr)
        return done.stderr

    def h5py(self):
        try:
            import h5py
        except ImportError:
            self.skipTest("h5py is not installed")
        return h5py
