"""What scripts/rig_session.sh starts for the other scripts: an emulated rig and a daemon for it."""

import subprocess
import unittest

import bench


class RigSession(unittest.TestCase):
    """The use of it in scripts/demo.sh."""

    def test_a_rig_and_a_daemon_come_up_and_end(self):
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
