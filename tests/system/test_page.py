"""Tests the operator's page in a real browser. The tests cover grips, lost parts, the end and the start of a
daemon, and the permissions of users."""

import http.server
import os
import pathlib
import threading

import bench
import browser
import web

SIZES = ((1920, 1080), (360, 740))

# A page of another web site. A user who may operate opens this page in the browser. The page then tries to send these
# requests to softgrip-web.
FORGERY = """<!doctype html><title>forged</title><script>
const body = JSON.stringify({command: "start", sequence: "pick_stone"});
const tries = ["text/plain", "application/json"].flatMap((type) => ["no-cors", "cors"].map((mode) =>
  fetch("TARGET/api/command", {method: "POST", mode, credentials: "include", body, headers: {"Content-Type": type}})
    .then((answer) => answer.type === "opaque" ? "unseen" : "status " + answer.status, () => "refused")));
tries.push(fetch("TARGET/api/session", {method: "POST", mode: "no-cors", credentials: "include", body: '{"token": "x"}'})
  .then((answer) => answer.type === "opaque" ? "unseen" : "status " + answer.status, () => "refused"));
tries.push(fetch("TARGET/api/status", {credentials: "include"}).then((a) => a.text(), () => "refused"));
Promise.all(tries).then((said) => { document.title = "tried " + said.join(", "); });
</script>"""

# Script that returns true for each canvas that shows a curve and whose axis has the colour of the colour scheme.
CURVES = """return Object.values(Chart.instances).map((c) => {
  const pixels = c.canvas.getContext("2d").getImageData(0, 0, c.canvas.width, c.canvas.height).data;
  const ink = getComputedStyle(document.body).getPropertyValue("--quiet").trim();
  return pixels.filter((value, i) => i % 4 === 3 && value > 0).length > 500 && c.options.scales.y.ticks.color === ink;
})"""


class Elsewhere:
    """A web server of another site on this machine."""

    def __init__(self, text):
        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                self.send_response(200)
                self.send_header("Content-Type", "text/html")
                self.end_headers()
                self.wfile.write(text.encode())

            def log_message(self, *arguments):
                pass
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.address = f"http://localhost:{self.server.server_port}"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def close(self):
        self.server.shutdown()
        self.server.server_close()


class Page(web.WebTest):
    def setUp(self):
        super().setUp()
        self.start_rig()

    def browse(self, told, *arguments):
        seen = browser.Browser(*arguments)
        self.addCleanup(seen.close)
        seen.open(told.address)
        return seen

    def log_in(self, seen, token):
        seen.type_in("token", token)
        seen.press(browser.ENTER)

    def test_the_page_shows_a_lost_part_and_a_stopped_grip(self):
        seen = self.browse(self.start_web())
        seen.wait_for_state("idle")
        seen.wait("sequences", lambda: "pick_stone" in seen.text("sequence"))
        seen.choose("sequence", "pick_stone")
        seen.type_in("parameter-squeeze_kpa", "4.25")
        seen.type_in("parameter-hold_s", "60")
        seen.click("start")
        seen.wait("HOLDING", lambda: seen.results() == ["HOLDING", "HOLDING"])
        self.assertEqual(self.softgripd.status()["sequence"]["parameters"]["squeeze_kpa"], 4.25)
        self.assertEqual(self.softgripd.status()["sequence"]["client"], "softgrip-web")
        self.assertIn("pick_stone", seen.text("doing"))
        self.board.ask("object out")
        seen.wait("PART LOST", lambda: seen.results() == ["PART LOST", "PART LOST"])
        self.assertEqual(seen.text("result"), "PART LOST")
        seen.click("vent")
        seen.wait_for_state("idle")
        self.board.ask("object back")
        seen.click("start")
        seen.wait("HOLDING", lambda: seen.results() == ["HOLDING", "HOLDING"])
        seen.click("stop")
        seen.wait("the stop", lambda: "stop: accepted" in seen.text("said"))
        ended = self.softgripd.wait_for_event("sequence_finished", code="stopped")
        self.assertEqual(ended["code"], "stopped")
        seen.wait_for_state("idle")
        seen.wait("the event", lambda: "ended: stopped" in seen.text("events"))
        seen.wait("the recordings", lambda: seen.text("recordings").count("pick_stone") == 2)
        points = seen.run("return Math.min(...Object.values(Chart.instances)"
                          ".map((c) => Math.min(...c.data.datasets.map((d) => d.data.length))))")
        self.assertGreater(points, 10)
        self.assertEqual(seen.complaints(), [])

    def test_the_page_shows_why_a_command_is_refused(self):
        seen = self.browse(self.start_web())
        seen.wait_for_state("idle")
        seen.click("stop")
        seen.wait("the refusal", lambda: seen.text("said").startswith("stop: "))
        seen.wait("the refusal", lambda: "accepted" not in seen.text("said") and len(seen.text("said")) > 12)

    def test_the_page_reconnects_after_restarts_of_daemon_and_softgrip_web(self):
        told = self.start_web()
        seen = self.browse(told)
        seen.wait_for_state("idle")
        seen.wait("sequences", lambda: "pick_stone" in seen.text("sequence"))
        seen.choose("sequence", "pick_stone")
        seen.type_in("parameter-squeeze_kpa", "4.25")
        self.softgripd.kill()
        seen.wait_for_state("no daemon")
        self.assertIn("does not respond", seen.text("alarm"))
        self.assertEqual(seen.results(), [])
        seen.click("stop")
        seen.wait("why nothing was stopped", lambda: "no daemon is running" in seen.text("said"))
        self.daemon(self.rig_path).wait_for_state("idle")
        seen.wait_for_state("idle")
        seen.wait("no alarm", lambda: not seen.find("alarm").is_displayed())
        told.kill()
        seen.wait_for_state("no connection")
        again = web.Web(self.folder, name="softgrip-web-again", port=told.port)
        self.processes.append(again)
        seen.wait_for_state("idle")
        seen.wait("sequences", lambda: "pick_stone" in seen.text("sequence"))
        for element, value in (("sequence", "pick_stone"), ("parameter-squeeze_kpa", "4.25")):
            self.assertEqual(seen.run(f"return document.getElementById('{element}').value"), value)

    def test_a_list_without_the_chosen_sequence_selects_no_other_sequence(self):
        seen = self.browse(self.start_web())
        seen.wait_for_state("idle")
        seen.wait("sequences", lambda: "pick_stone" in seen.text("sequence"))
        seen.choose("sequence", "pick_stone")
        seen.type_in("parameter-squeeze_kpa", "4.25")
        value = "return document.getElementById('{}').value"
        file = next(self.folder.rglob("pick_stone.yaml"))
        away = file.rename(file.with_suffix(".away"))
        seen.wait("a list without the sequence", lambda: "pick_stone" not in seen.text("sequence"))
        self.assertEqual(seen.run(value.format("sequence")), "")
        self.assertFalse(seen.find("start").is_enabled())
        away.rename(file)
        seen.wait("a list with the sequence", lambda: "pick_stone" in seen.text("sequence"))
        self.assertEqual(seen.run(value.format("sequence")), "pick_stone")
        self.assertEqual(seen.run(value.format("parameter-squeeze_kpa")), "4.25")
        self.assertTrue(seen.find("start").is_enabled())

    def test_a_page_of_another_site_can_neither_command_nor_read(self):
        told = self.start_web(access="without_token: operate")
        seen = self.browse(told)
        seen.wait_for_state("idle")
        elsewhere = Elsewhere(FORGERY.replace("TARGET", told.address))
        self.addCleanup(elsewhere.close)
        seen.open(elsewhere.address)
        title = seen.wait("the tries", lambda: seen.driver.title.startswith("tried") and seen.driver.title)
        said = title.removeprefix("tried ").split(", ")
        self.assertEqual(set(said) - {"refused", "unseen"}, set())
        self.assertEqual(said[-1], "refused")
        self.assertNotIn("sequence_started", {e["kind"] for e in self.softgripd.events()})
        # Some of the requests have reached the server. The server has refused each of them because of its origin,
        # before any other check.
        answers = {bench.re.search(r"\d+", name).group() for name in told.metrics() if "answers_total" in name}
        self.assertIn("403", answers)
        self.assertEqual(answers & {"401", "415"}, set())
        # The page of softgrip-web sends the same request, and the sequence starts. This shows that the origin was the
        # only reason for the refusals.
        seen.open(told.address)
        status = seen.run_async("const done = arguments[0]; fetch('/api/command', {method: 'POST', headers:"
                                "{'Content-Type': 'application/json'}, body: JSON.stringify({command: 'start',"
                                "sequence: 'pick_stone'})}).then((a) => done(a.status))")
        self.assertEqual(status, 200)

    def test_a_read_only_user_has_no_buttons_and_cannot_command(self):
        seen = self.browse(self.start_web(access="without_token: none"))
        seen.wait_for_state("log in first")
        self.assertFalse(seen.find("main").is_displayed())
        self.log_in(seen, "x" * 24)
        seen.wait("the refusal", lambda: "unknown token" in seen.text("said"))
        self.log_in(seen, web.LOOK)
        seen.wait_for_state("idle")
        self.assertEqual(seen.visible_buttons(), ["Log out"])
        status = seen.run_async("const done = arguments[0]; fetch('/api/command', {method: 'POST', headers:"
                                "{'Content-Type': 'application/json'}, body: '{\"command\": \"vent\"}'})"
                                ".then((a) => done(a.status))")
        self.assertEqual(status, 403)
        self.assertEqual(seen.run("return document.cookie"), "", "scripts cannot read the session cookie")
        seen.driver.find_element(browser.By.CSS_SELECTOR, "#who button").click()
        seen.wait_for_state("log in first")
        self.log_in(seen, web.OPERATE)
        seen.wait("the buttons", lambda: "STOP" in seen.visible_buttons())
        self.assertIn("VENT", seen.visible_buttons())

    def test_a_session_ends_after_the_configured_time(self):
        seen = self.browse(self.start_web(access="without_token: none\n  session_s: 10"))
        seen.wait_for_state("log in first")
        self.log_in(seen, web.OPERATE)
        seen.wait_for_state("idle")
        seen.wait_for_state("log in first")
        self.assertEqual([b for b in seen.visible_buttons() if b != "Log in"], [])

    def test_the_page_meets_contrast_size_and_keyboard_requirements(self):
        pictures = pathlib.Path(os.environ.get("SOFTGRIP_PICTURES", self.folder))
        seen = self.browse(self.start_web())
        seen.wait_for_state("idle")
        seen.wait("sequences", lambda: "pick_stone" in seen.text("sequence"))
        seen.choose("sequence", "pick_stone")
        seen.click("start")
        seen.wait("HOLDING", lambda: seen.results() == ["HOLDING", "HOLDING"])
        self.board.ask("object out")
        seen.wait("PART LOST", lambda: seen.results() == ["PART LOST", "PART LOST"])
        for width, height in SIZES:
            for dark in (False, True):
                with self.subTest(width=width, dark=dark):
                    seen.look_like(width, height, dark)
                    bench.time.sleep(0.6)
                    self.assertEqual(seen.nameless(), [])
                    self.assertEqual(seen.faint(), [])
                    self.assertLessEqual(seen.run("return document.documentElement.scrollWidth"), width)
                    small = seen.run("return [...document.querySelectorAll('#halt button')].map((b) =>"
                                     "b.getBoundingClientRect()).filter((r) => r.height < 64 || r.width < 64).length")
                    self.assertEqual(small, 0)
                    self.assertEqual(seen.run(CURVES), [True, True])
                    seen.picture(pictures / f"page-{width}-{'dark' if dark else 'light'}.png", width)
        seen.look_like(*SIZES[0], False)
        seen.driver.refresh()  # moves the keyboard focus back to the top of the page
        seen.wait("sequences", lambda: "pick_stone" in seen.text("sequence"))
        seen.run("const s = document.getElementById('sequence'); s.value = 'pick_stone';"
                 "s.dispatchEvent(new Event('change'))")
        reached = []
        for _ in range(20):
            seen.press(browser.TAB)
            reached.append(seen.focused())
        for name in ("stop", "vent", "sequence", "parameter-squeeze_kpa", "events", "recordings"):
            self.assertIn(name, reached)
        self.assertLess(reached.index("stop"), 3, "the stop button must come before the other controls")
        ring = seen.run("document.getElementById('stop').focus({focusVisible: true});"
                        "return getComputedStyle(document.getElementById('stop')).outlineStyle")
        self.assertEqual(ring, "solid")
        seen.run("document.getElementById('vent').focus()")
        seen.press(browser.ENTER)
        seen.wait("the vent", lambda: "vent: accepted" in seen.text("said"))
        self.assertEqual(seen.complaints(), [])


if __name__ == "__main__":
    bench.main()
