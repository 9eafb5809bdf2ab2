// The operator's page. All data come from one event stream, and each command is one POST request.

const $ = (id) => document.getElementById(id);
const shown = {status: null, statistics: null, sequences: [], events: [], trend: [], typed: {}};
let session = {role: "none", tokens: false, commands: false};
let stream = null;
let heardAt = 0;

const make = (tag, text = "", className = "") => {
  const element = document.createElement(tag);
  if (text !== "") element.textContent = text;
  if (className) element.className = className;
  return element;
};
// A value that rounds to zero has no minus sign.
const fixed = (value, digits, unit) =>
  (typeof value === "number" ? `${value.toFixed(digits).replace(/^-(0\.?0*)$/, "$1")} ${unit}` : "–");
const setText = (element, text) => { if (element.textContent !== text) element.textContent = text; };
const operates = () => session.role === "operate" && session.commands;

// ---------------------------------------------------------------------------------------------- asking the server

async function ask(path, body, method = body === undefined ? "GET" : "POST") {
  const request = {method, headers: {}};
  if (body !== undefined) {
    request.headers["Content-Type"] = "application/json";
    request.body = JSON.stringify(body);
  }
  const answer = await fetch(path, request);
  const json = await answer.json().catch(() => ({}));
  if (!answer.ok) throw new Error(json.error || `${answer.status} ${answer.statusText}`);
  return json;
}

function say(text, tone = "") {
  const line = $("said");
  line.className = tone;
  line.textContent = text;
}

async function command(name, more = {}) {
  say(`${name} ...`);
  try {
    const result = await ask("/api/command", {command: name, ...more});
    const warnings = (result.warnings || []).map((warning) => warning.message).join("; ");
    say(warnings ? `${name}: accepted. ${warnings}` : `${name}: accepted`, warnings ? "doubt" : "good");
  } catch (error) {
    say(`${name}: ${error.message}`, "bad");
  }
}

// ------------------------------------------------------------------------------------------------------- the state

const toneOfResult = {"HOLDING": "good", "RELEASED": "good", "NO PART": "doubt", "PART LOST": "bad", "ERROR": "bad"};
const toneOfState = {idle: "good", running: "good", faulted: "bad", stopping: "doubt"};
const toneOfHealth = {healthy: "good", suspect: "doubt", unfit: "bad"};

function showPill(element, text, tone) {
  setText(element, text);
  element.className = `pill ${tone || ""}`;
}

function sentenceOfAlarm(status) {
  if (!status) return "softgripd does not respond. The values on this page are out of date.";
  if (status.fault) {
    const finger = status.fault.channel ? ` of ${status.fault.channel}` : "";
    return `${status.fault.code} ${status.fault.name}${finger}: ${status.fault.meaning} ${status.fault.next}`;
  }
  return status.under_pressure ? `Idle with pressurised fingers: ${status.under_pressure.text}` : "";
}

function showHead(status) {
  setText($("rig"), status ? status.rig + (status.simulated ? " (simulated)" : "") : "softgrip");
  document.title = status ? `${status.rig}: ${status.state}` : "softgrip";
  showPill($("state"), status ? status.state : "no daemon", status ? toneOfState[status.state] : "bad");
  const result = status ? status.result : "-";
  $("result").hidden = result === "-";
  showPill($("result"), result, toneOfResult[result]);
  const sequence = status && status.sequence;
  let doing = "";
  if (sequence) {
    doing = sequence.ended ? `${sequence.name}: ${sequence.ended}`
      : `${sequence.name}: step ${sequence.step + 1} of ${sequence.steps}, ${sequence.step_name}`;
    if (status.owner) doing += `, started by ${status.owner}`;
  }
  setText($("doing"), doing);
  const alarm = sentenceOfAlarm(status);
  setText($("alarm"), alarm);
  $("alarm").hidden = !alarm;
}

const rowsOfFinger = (channel) => [
  ["Displacement", fixed(channel.displacement_mm, 2, "mm")],
  ["Reference", fixed(channel.reference_mm, 2, "mm")],
  ["Pressure", fixed(channel.pressure_kpa, 1, "kPa")],
  ...(typeof channel.temperature_c === "number" ? [["Temperature", fixed(channel.temperature_c, 1, "°C")]] : []),
  ["Command", fixed(channel.command_kpa, 1, "kPa")],
  ["Gripping pressure", fixed(channel.squeeze_kpa, 1, "kPa")],
  ["Reading", channel.validity === "valid" ? `${fixed(channel.age_s * 1000, 0, "ms")} old` : channel.validity,
    channel.validity === "valid" ? "" : "bad"],
  ["Model", channel.health, toneOfHealth[channel.health]],
  ["Limit", channel.limit_text || "–", channel.limit ? "doubt" : ""],
];

function showRows(list, rows) {
  while (list.children.length > 2 * rows.length) list.lastChild.remove();
  rows.forEach(([name, text, tone], i) => {
    if (list.children.length <= 2 * i) list.append(make("dt"), make("dd"));
    setText(list.children[2 * i], name);
    setText(list.children[2 * i + 1], text);
    list.children[2 * i + 1].className = tone || "";
  });
}

function showFingers(status) {
  const channels = status ? status.channels : [];
  const place = $("fingers");
  place.classList.toggle("alone", !operates());
  while (place.children.length > channels.length) place.lastChild.remove();
  channels.forEach((channel, i) => {
    if (place.children.length <= i) {
      const card = make("article", "", "card finger");
      const head = make("header");
      head.append(make("h2"), make("p", "", "big"));
      card.append(head, make("dl"));
      place.append(card);
    }
    const [head, list] = place.children[i].children;
    setText(head.children[0], channel.name);
    setText(head.children[1], channel.result === "-" ? "–" : channel.result);
    head.children[1].className = `big ${toneOfResult[channel.result] || ""}`;
    showRows(list, rowsOfFinger(channel));
  });
}

function showHealth(status, statistics) {
  if (!status) return showRows($("health"), []);
  const {bus, loop, recording} = status;
  const rows = [
    ["Board", bus.connected ? "connected" : bus.failure || "does not respond", bus.connected ? "good" : "bad"],
    ["Control loop", `${status.rate_hz} Hz, ${loop.slips} of ${loop.ticks} cycles missed`, loop.slips ? "doubt" : ""],
    ["Wake-up latency of the loop", `p99 ${loop.wake_up_p99_us.toFixed(0)} µs, maximum ${loop.wake_up_max_us.toFixed(0)} µs`],
  ];
  if (statistics) {
    const {exchanges, failures, exchange} = statistics.bus;
    rows.push(["Exchanges with the board", `${failures} of ${exchanges} failed`, failures ? "doubt" : ""]);
    rows.push(["Duration of an exchange", `p99 ${(exchange.p99_us / 1000).toFixed(2)} ms`]);
  }
  if (status.real_time) {
    rows.push(["Real time", status.real_time.degraded ? "degraded" : "all requested settings verified",
      status.real_time.degraded ? "doubt" : "good"]);
  }
  const written = recording.active ? `${recording.rows} rows` : "not active";
  rows.push(["Recording", recording.error || written, recording.error ? "bad" : ""]);
  rows.push(["Lost rows of the recording", String(recording.dropped_rows), recording.dropped_rows ? "doubt" : ""]);
  showRows($("health"), rows);
}

function enable(status) {
  const state = status ? status.state : "";
  $("start").disabled = state !== "idle" || !$("sequence").value;
  $("release").disabled = !status || (state !== "running" && !status.under_pressure);
  $("acknowledge").disabled = !status || (!status.fault && status.result === "-");
}

// ------------------------------------------------------------------------------------------------ events, recordings

const toneOfSeverity = {warning: "doubt", error: "bad"};
const mostEvents = 200;

function showEvent(event) {
  const line = make("li", "", toneOfSeverity[event.severity]);
  const at = make("time", new Date(event.at).toLocaleTimeString());
  at.dateTime = event.at;
  line.append(at, event.severity === "information" ? "" : `${event.severity}: `, event.text);
  $("events").prepend(line);
  while ($("events").children.length > mostEvents) $("events").lastChild.remove();
}

function linkTo(recording, file) {
  const link = make("a", file);
  link.href = `/recordings/${recording}/${file}`;
  link.target = "_blank";
  link.rel = "noopener";
  return link;
}

async function showRecordings() {
  const {recordings, error} = await ask("/api/recordings").catch((reason) => ({recordings: [], error: reason.message}));
  const list = $("recordings");
  list.replaceChildren();
  if (!recordings.length) list.append(make("li", error || "none"));
  for (const {name, files} of recordings) {
    const line = make("li");
    line.append(make("div", name), ...files.map((file) => linkTo(name, file)));
    const picture = files.find((file) => /\.(svg|png)$/.test(file));
    if (picture && list.children.length < 3) {
      const image = make("img");
      image.src = `/recordings/${name}/${picture}`;
      image.alt = `Curves of ${name}`;
      image.loading = "lazy";
      line.append(image);
    }
    list.append(line);
  }
}

// ------------------------------------------------------------------------------------------------------------ curves

// Columns of a sample per finger, after the time: command, pressure, displacement, reference.
const curves = {
  "pressure-chart": [{column: 1, dashed: false}, {column: 0, dashed: true}],
  "displacement-chart": [{column: 2, dashed: false}, {column: 3, dashed: true}],
};
const charts = {};
const dark = matchMedia("(prefers-color-scheme: dark)");
const hues = () => (dark.matches ? ["#7db8f5", "#f2b45c", "#6fd49a", "#e29bf0"] : ["#0b57a4", "#b35900", "#0b6b35", "#7a2a8c"]);

function datasetsOf(id) {
  const channels = shown.status ? shown.status.channels : [];
  return channels.flatMap((channel, finger) => curves[id].map(({column, dashed}) => ({
    label: channel.name + (dashed ? (id === "pressure-chart" ? ", command" : ", reference") : ""),
    data: shown.trend.map((sample) => ({x: sample[0], y: (sample[finger + 1] || [])[column] ?? NaN})),
    borderColor: hues()[finger % 4],
    backgroundColor: hues()[finger % 4],
    borderWidth: dashed ? 1.5 : 2,
    borderDash: dashed ? [5, 4] : [],
  })));
}

function chartOf(id) {
  return new Chart($(id), {
    type: "line",
    data: {datasets: []},
    options: {
      animation: false, parsing: false, normalized: true, spanGaps: false, maintainAspectRatio: false,
      events: [],
      elements: {point: {radius: 0}},
      plugins: {legend: {labels: {boxWidth: 18, boxHeight: 1}}, tooltip: {enabled: false}},
      scales: {
        x: {type: "linear", grid: {}, ticks: {maxTicksLimit: 7, callback: (value) => `${value} s`}},
        y: {grid: {}, ticks: {}, grace: "5%"},
      },
    },
  });
}

// Reads the colours of the present scheme, which may change while the page is open.
function colour(options) {
  const style = getComputedStyle(document.body);
  const ink = style.getPropertyValue("--quiet").trim();
  options.plugins.legend.labels.color = ink;
  for (const scale of [options.scales.x, options.scales.y]) {
    scale.ticks.color = ink;
    scale.grid.color = style.getPropertyValue("--line").trim();
  }
}

function drawCurves() {
  if (typeof Chart === "undefined") {
    document.querySelectorAll(".canvas").forEach((place) => {
      place.textContent = "The curves are not shown, because the package libjs-chart.js is not installed.";
    });
    return;
  }
  const newest = shown.trend.length ? shown.trend[shown.trend.length - 1][0] : 0;
  for (const id of Object.keys(curves)) {
    charts[id] ||= chartOf(id);
    charts[id].data.datasets = datasetsOf(id);
    colour(charts[id].options);
    charts[id].options.scales.x.min = Math.max(0, Math.floor(newest) - 60);
    charts[id].options.scales.x.max = Math.max(60, Math.ceil(newest));
    charts[id].update("none");
  }
}

dark.addEventListener("change", () => requestAnimationFrame(drawCurves));

// ---------------------------------------------------------------------------------------------------------- sequences

function showSequences(sequences) {
  shown.sequences = (sequences || []).filter((sequence) => !sequence.problems.length);
  const select = $("sequence");
  if (select.value) shown.chosen = select.value;
  select.replaceChildren(...shown.sequences.map(({name}) => new Option(name, name)));
  // Another sequence must not take the place of a sequence that was removed or has become faulty. A list without the
  // chosen sequence selects none, so the choice is also kept for the next list.
  if (shown.chosen) select.value = shown.chosen;
  showParameters();
}

// The units of parameters as text.
const units = {kpa: "kPa", mm_per_s: "mm/s", kpa_per_s: "kPa/s"};

function showParameters() {
  const sequence = shown.sequences.find(({name}) => name === $("sequence").value);
  setText($("about"), sequence ? sequence.about : "");
  // A new list of sequences must not change the typed values, also if a list in between lacks the sequence.
  $("parameters").querySelectorAll("input").forEach((input) => { shown.typed[input.name] = input.value; });
  if (sequence && shown.parametersOf !== sequence.name) Object.assign(shown, {typed: {}, parametersOf: sequence.name});
  $("parameters").replaceChildren(...(sequence ? sequence.parameters : []).map((parameter) => {
    const line = make("div");
    const unit = units[parameter.unit] || parameter.unit;
    const label = make("label", `${parameter.about || parameter.name}, ${parameter.lower} to ${parameter.upper} ${unit}`);
    const input = make("input");
    input.id = `parameter-${parameter.name}`;
    label.htmlFor = input.id;
    Object.assign(input, {type: "number", name: parameter.name, min: parameter.lower, max: parameter.upper, step: "any",
      value: shown.typed[parameter.name] ?? parameter.default, required: true});
    line.append(label, input);
    return line;
  }));
  enable(shown.status);
}

// ------------------------------------------------------------------------------------------------- the stream, the role

function showStatus(status) {
  const before = shown.status;
  shown.status = status;
  showHead(status);
  showFingers(status);
  showHealth(status, shown.statistics);
  enable(status);
  if (before && status && before.recording.active && !status.recording.active) showRecordings();
}

function takeStatus(status) {
  if (!status || (shown.trend.length && status.time_s < shown.trend[shown.trend.length - 1][0])) shown.trend = [];
  if (status) {
    shown.trend.push([status.time_s, ...status.channels.map((channel) =>
      [channel.command_kpa, channel.pressure_kpa, channel.displacement_mm, channel.reference_mm])]);
    shown.trend = shown.trend.filter(([time]) => time > status.time_s - 60);
  }
  showStatus(status);
  drawCurves();
}

function takeGreeting({status, statistics, sequences, events, trend}) {
  Object.assign(shown, {statistics, trend});
  $("events").replaceChildren();
  events.forEach(showEvent);
  showStatus(status);
  showSequences(sequences);
  drawCurves();
  showRecordings();
}

function follow() {
  if (stream) stream.close();
  stream = new EventSource("/api/stream");
  const on = (kind, take) => stream.addEventListener(kind, (message) => {
    heardAt = Date.now();
    document.body.classList.remove("stale");
    take(JSON.parse(message.data));
  });
  on("hello", takeGreeting);
  on("state", takeStatus);
  on("happened", showEvent);
  on("statistics", (statistics) => { shown.statistics = statistics; showHealth(shown.status, statistics); });
  on("sequences", showSequences);
  on("ended", begin);
}

function showRole() {
  document.querySelectorAll(".for-operators").forEach((part) => { part.hidden = !operates(); });
  $("main").hidden = session.role === "none";
  $("login").hidden = session.role !== "none";
  const who = $("who");
  who.replaceChildren(session.role === "none" ? "" : operates() ? "may move the gripper" : "read-only");
  if (session.tokens && session.role !== "none") {
    const change = make("button", session.byToken ? "Log out" : "Log in");
    change.type = "button";
    change.addEventListener("click", () => (session.byToken ? leave() : ($("login").hidden = false, $("token").focus())));
    who.append(change);
  }
}

async function begin() {
  if (stream) stream.close();
  stream = null;
  try {
    session = await ask("/api/session");
  } catch (error) {
    showPill($("state"), "no connection", "bad");
    setTimeout(begin, 2000);
    return;
  }
  showRole();
  if (session.role !== "none") follow();
  else showPill($("state"), "log in first", "doubt");
}

async function leave() {
  await ask("/api/session", undefined, "DELETE").catch(() => {});
  location.reload();
}

// If the stream is silent, mark the values as out of date. If it is closed, open it again.
setInterval(() => {
  if (!stream || Date.now() - heardAt < 3000) return;
  document.body.classList.add("stale");
  showPill($("state"), "no connection", "bad");
  if (stream.readyState === EventSource.CLOSED) begin();
}, 1000);

$("stop").addEventListener("click", () => command("stop"));
$("vent").addEventListener("click", () => command("vent"));
$("release").addEventListener("click", () => command("release"));
$("acknowledge").addEventListener("click", () => command("acknowledge"));
$("sequence").addEventListener("change", showParameters);
$("start-form").addEventListener("submit", (event) => {
  event.preventDefault();
  const parameters = {};
  $("parameters").querySelectorAll("input").forEach((input) => { parameters[input.name] = input.valueAsNumber; });
  command("start", {sequence: $("sequence").value, parameters});
});
$("login-form").addEventListener("submit", async (event) => {
  event.preventDefault();
  try {
    await ask("/api/session", {token: $("token").value});
    $("token").value = "";
    say("");
    begin();
  } catch (error) {
    say(`login failed: ${error.message}`, "bad");
  }
});
begin();
