"""Tests that Prometheus reads the values of the daemon."""

import json
import shutil
import subprocess
import urllib.parse
import urllib.request

import bench
import web

PROMETHEUS, PROMTOOL = "/usr/bin/prometheus", "/usr/bin/promtool"


class Prometheus(bench.Process):
    """A Prometheus server on its own free port that reads the metrics every second."""

    def __init__(self, folder, port, target, rules):
        config = folder / "prometheus.yml"
        config.write_text(
            "global: {scrape_interval: 1s, evaluation_interval: 1s}\n"
            f"rule_files: [{rules}]\n"
            f"scrape_configs: [{{job_name: softgrip, static_configs: [{{targets: ['{target}']}}]}}]\n")
        self.port = port
        super().__init__("prometheus", [PROMETHEUS, f"--config.file={config}", f"--storage.tsdb.path={folder}/tsdb",
                                        f"--web.listen-address=127.0.0.1:{port}"], folder)

    def ask(self, path, **query):
        url = f"http://127.0.0.1:{self.port}/api/v1/{path}?{urllib.parse.urlencode(query)}"
        try:
            with urllib.request.urlopen(url, timeout=bench.PATIENCE_S) as answer:
                return json.load(answer)["data"]
        except OSError:
            if not self.running():
                raise AssertionError(f"prometheus ended: {self.errors()}") from None
            return None

    def value(self, expression):
        data = self.ask("query", query=expression)
        return float(data["result"][0]["value"][1]) if data and data["result"] else None

    def firing(self):
        data = self.ask("alerts")
        return {a["labels"]["alertname"] for a in data["alerts"] if a["state"] == "firing"} if data else set()


def free_port():
    with bench.socket.create_server(("127.0.0.1", 0)) as listener:
        return listener.getsockname()[1]


class Metrics(web.WebTest):
    def promtool(self, *arguments, text=None):
        done = subprocess.run([PROMTOOL, *map(str, arguments)], input=text, capture_output=True, text=True,
                              timeout=bench.PATIENCE_S)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def test_the_alert_rules_are_valid_and_pass_their_tests(self):
        self.assertIn("15 rules found", self.promtool("check", "rules", bench.SOURCE / "config/monitoring/alerts.yml"))
        self.promtool("test", "rules", bench.SOURCE / "tests/monitoring/alerts_test.yaml")
        self.promtool("check", "config", "--syntax-only", bench.SOURCE / "config/monitoring/prometheus.yml")

    def test_rules_dashboard_and_page_name_only_existing_metrics(self):
        self.start_rig()
        results = self.folder / "runs/health"
        results.mkdir(parents=True)
        (results / "health.json").write_text(json.dumps({"made_unix_s": 1795313181, "shared": ["gain_mm"], "fingers": [
            {"finger": "left", "state": "alarm", "suspects": [{"id": "leak"}]}]}))
        told = self.start_web()
        bench.wait_for("statistics", lambda: "softgrip_loop_ticks_total" in told.metrics())
        _, text, _ = told.ask("/metrics")
        self.assertEqual(self.promtool("check", "metrics", text=text).strip(), "")
        names = {line.split()[2] for line in text.splitlines() if line.startswith("# TYPE")}
        for name in ("alerts.yml", "grafana.json"):
            asked = set(bench.re.findall(r"softgrip_\w+", (bench.SOURCE / "config/monitoring" / name).read_text()))
            self.assertEqual(asked - names, set(), name)
        page = (bench.SOURCE / "docs/reference/metrics.md").read_text()
        self.assertEqual(set(bench.re.findall(r"`(softgrip_\w+)`", page)) ^ (names | {"softgrip_emergency_stop",
                         "softgrip_digital_lines_lost"}), set())

    def test_scraped_metrics_equal_the_events_of_the_daemon(self):
        self.start_rig()
        told = self.start_web()
        rules = shutil.copy(bench.SOURCE / "config/monitoring/alerts.yml", self.folder)
        prometheus = Prometheus(self.folder, free_port(), f"127.0.0.1:{told.port}", rules)
        self.processes.append(prometheus)
        bench.wait_for("the first scrape", lambda: prometheus.value("softgrip_up") == 1)
        for _ in range(2):
            self.softgripd.start("pick_stone")
            bench.wait_for("HOLDING", lambda: set(self.softgripd.results()) == {"HOLDING"})
            self.board.ask("object out")
            bench.wait_for("PART LOST", lambda: set(self.softgripd.results()) == {"PART LOST"})
            self.softgripd.result("vent")
            self.softgripd.wait_for_state("idle")
            self.board.ask("object back")
            bench.time.sleep(1)
        events = self.softgripd.events()
        happened = sum(e["kind"] == "grip_result" and e["code"] == "PART LOST" and e["channel"] == "left"
                       for e in events)
        self.assertEqual(happened, 2)
        counted = [e["count"] for e in self.softgripd.result("statistics")["events"]
                   if (e["kind"], e.get("code"), e.get("channel")) == ("grip_result", "PART LOST", "left")]
        self.assertEqual(counted, [happened])
        lost = 'softgrip_grip_results_total{channel="left",result="part_lost"}'
        bench.wait_for("the value", lambda: prometheus.value(lost) == happened)
        self.assertEqual(prometheus.value('softgrip_grip_results_total{channel="left",result="holding"}'), 2)
        self.assertEqual(prometheus.value("softgrip_sequences_started_total"), 2)
        self.softgripd.kill()
        bench.wait_for("0 without the daemon", lambda: prometheus.value("softgrip_up") == 0)
        self.assertIsNone(prometheus.value("softgrip_displacement_meters"))
        again = self.idle_daemon(self.rig_path)
        bench.wait_for("the next daemon", lambda: prometheus.value("softgrip_up") == 1)
        bench.wait_for("its own counts", lambda: prometheus.value(lost) == 0)


if __name__ == "__main__":
    bench.main()
