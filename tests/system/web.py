"""Runs a softgrip-web process together with the other processes of a test."""

import json
import urllib.error
import urllib.request

import bench

SOFTGRIP_WEB = bench.BUILD / "tools" / "softgrip-web"
LOOK, OPERATE = "look-" + "a" * 20, "operate-" + "b" * 20


class Web(bench.Process):
    """A process of softgrip-web on a free port for the daemon of the test. `access` is the text of the access file.
    `operate` is the socket for commands."""

    def __init__(self, folder, access="without_token: operate", name="softgrip-web", port=0, most=64, environment=None,
                 operate=None):
        tokens = folder / "web.tokens"
        tokens.write_text(f"look {LOOK}\noperate {OPERATE}\n")
        tokens.chmod(0o600)
        self.config = folder / f"{name}.yaml"
        self.config.write_text(
            f"name: test\ndaemon: {{look: {folder}/softgripd.sock, operate: {operate or folder / 'softgripd.sock'}}}\n"
            f"listen: {{address: 127.0.0.1, port: {port}, max_connections: {most}}}\n"
            f"access:\n  tokens: {tokens}\n  {access}\nrecordings: {folder}/runs\n")
        super().__init__(name, [SOFTGRIP_WEB, "--config", self.config], folder, environment)
        self.port = self.listening_port()
        self.address = f"http://127.0.0.1:{self.port}"

    def ask(self, path, body=None, method=None, token=None, headers=()):
        """Sends a request like the page, or with a token. Returns (status, text, headers)."""
        request = urllib.request.Request(self.address + path, method=method,
                                         data=None if body is None else json.dumps(body).encode())
        if body is not None:
            request.add_header("Content-Type", "application/json")
        request.add_header("Origin", self.address)
        if token:
            request.add_header("Authorization", f"Bearer {token}")
        for name, value in dict(headers).items():
            request.add_header(name, value)
        try:
            with urllib.request.urlopen(request, timeout=bench.PATIENCE_S) as answer:
                return answer.status, answer.read().decode(), answer.headers
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.read().decode(), error.headers

    def command(self, command, **keys):
        status, text, _ = self.ask("/api/command", {"command": command, **keys})
        return status, json.loads(text)

    def metrics(self):
        """Returns the values of the metrics. The keys are the names with labels, as in the text."""
        status, text, _ = self.ask("/metrics")
        if status != 200:
            raise AssertionError(f"/metrics: {status} {text}")
        lines = (line.rpartition(" ") for line in text.splitlines() if not line.startswith("#"))
        return {name: float(value) for name, _, value in lines}


class WebTest(bench.BenchTest):
    """A test class with an emulated rig, its daemon, and softgrip-web."""

    def start_web(self, **keys):
        process = Web(self.folder, **keys)
        self.processes.append(process)
        return process
