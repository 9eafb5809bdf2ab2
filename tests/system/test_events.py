"""Tests softgrip events."""

import json

import bench


class Events(bench.BenchTest):
    def test_follow_prints_every_new_event(self):
        self.start_rig()
        follower = bench.Process("following", [bench.SOFTGRIP, "events", "-n", "1", "-f", "--json", "--socket",
                                               self.softgripd.socket_path], self.folder)
        self.processes.append(follower)
        bench.wait_for("the newest event", lambda: follower.output().endswith("\n"))
        self.softgripd.start("pick_stone")
        self.softgripd.result("vent")
        self.softgripd.wait_for_state("idle")
        newest = self.softgripd.events()[-1]["id"]

        def ids():
            return [json.loads(line)["id"] for line in follower.output().splitlines(keepends=True) if line.endswith("\n")]
        bench.wait_for("the last event", lambda: ids()[-1] >= newest)
        self.assertEqual(ids(), list(range(ids()[0], ids()[-1] + 1)), "a gap means that an event was not printed")
        self.assertGreater(len(ids()), 4)
        self.assertEqual(follower.errors(), "")


if __name__ == "__main__":
    bench.main()
