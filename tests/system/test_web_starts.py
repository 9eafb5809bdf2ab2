"""Tests starts from a browser that does not receive the reply. softgrip-web must stop the started sequence by the id of
the start. It must not stop any other sequence."""

import json
import signal
import socket
import time

import bench
import quiet_rig
import web
from socket_proxy import TO_CLIENT, TO_DAEMON, SocketProxy

BODY = json.dumps({"command": "start", "sequence": "long"})
REQUEST = (f"POST /api/command HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\nContent-Type: application/json\r\n"
           f"Content-Length: {len(BODY)}\r\n\r\n{BODY}").encode()


class WebStarts(quiet_rig.QuietRigTest):
    def setUp(self):
        super().setUp()
        self.write("config/sequences/long.yaml", quiet_rig.LONG)
        self.proxy = SocketProxy(self.folder / "proxy.sock", self.path)
        self.addCleanup(self.proxy.close)
        self.web = web.Web(self.folder, operate=self.proxy.path)
        self.processes.append(self.web)

    def open_start(self):
        """A browser that has sent a start and waits for the answer."""
        browser = socket.create_connection(("127.0.0.1", self.web.port))
        self.addCleanup(browser.close)
        browser.sendall(REQUEST)
        return browser

    def wait_until_asked(self, command):
        bench.wait_for(f"softgrip-web to ask for a {command}",
                       lambda: any(f'"command":"{command}"'.encode() in text for text in self.proxy.waiting(TO_DAEMON)))

    def wait_until_running(self):
        return bench.wait_for("a sequence that runs", self.running)

    def check_nothing_begins(self):
        time.sleep(1)
        self.assertIsNone(self.running())

    def test_a_start_without_a_reply_in_time_is_stopped(self):
        self.proxy.hold()
        status, answer = self.web.command("start", sequence="long")
        self.assertEqual((status, answer["code"]), (503, "no_answer"))
        self.wait_until_asked("stop")
        self.proxy.let_go()
        self.check_nothing_begins()

    def test_a_pending_start_is_cancelled_if_the_browser_disconnects(self):
        self.proxy.hold()
        browser = self.open_start()
        self.wait_until_asked("start")
        browser.close()
        self.wait_until_asked("stop")
        self.proxy.let_go()
        self.check_nothing_begins()

    def test_an_accepted_start_is_stopped_if_the_browser_disconnects(self):
        self.proxy.hold(TO_CLIENT)
        browser = self.open_start()
        request = self.wait_until_running()
        browser.close()
        self.assertEqual(self.wait_until_ended(request), "stopped")

    def test_a_start_is_stopped_if_the_daemon_connection_is_lost(self):
        self.proxy.hold(TO_CLIENT)
        self.open_start()
        request = self.wait_until_running()
        self.proxy.cut()
        self.assertEqual(self.wait_until_ended(request), "stopped")

    def test_a_start_is_stopped_if_softgrip_web_ends_before_the_reply(self):
        self.proxy.hold(TO_CLIENT)
        self.open_start()
        request = self.wait_until_running()
        self.assertEqual(self.web.end(signal.SIGTERM), 0)
        self.assertEqual(self.wait_until_ended(request), "stopped")

    def test_a_cancelled_start_does_not_stop_another_client(self):
        self.proxy.hold()
        browser = self.open_start()
        self.wait_until_asked("start")
        theirs = self.softgripd.result("start", sequence="long")["request"]
        browser.close()
        self.wait_until_asked("stop")
        self.proxy.let_go()
        time.sleep(1)
        self.assertEqual(self.running(), theirs)

    def test_a_start_with_a_delivered_reply_continues(self):
        status, answer = self.web.command("start", sequence="long")
        self.assertEqual(status, 200, answer)
        time.sleep(1)
        self.assertEqual(self.running(), answer["request"])


if __name__ == "__main__":
    bench.main()
