"""Tests scripts/rig_session.sh, which starts an emulated rig and its daemon for the other scripts."""

import subprocess
import unittest

import bench


class RigSession(unittest.TestCase):
    """Tests that scripts/demo.sh can use scripts/rig_session.sh."""

    def test_the_script_starts_and_ends_a_rig_and_a_daemon(self):
        done = subprocess.run(["bash", "-euc", """
            build=$1 work=$(mktemp -d)
            runs=$work/runs
            mkdir "$runs"
            . scripts/rig_session.sh
            trap 'stop_daemon; stop_rig; rm -rf "$work"' EXIT
            start_rig --object stone
            start_daemon
            "$softgrip" status
            stop_daemon
            stop_rig
            """, "session", str(bench.BUILD)], cwd=bench.SOURCE, capture_output=True, text=True,
                              timeout=bench.PATIENCE_S)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("idle", done.stdout)


if __name__ == "__main__":
    bench.main()
