"use strict";

const $ = (id) => document.getElementById(id);
const make = (name, text, css) => {
  const made = document.createElement(name);
  if (text !== undefined) made.textContent = text;
  if (css) made.className = css;
  return made;
};
const svg = (name, attributes) => {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
};
const remember = (key, value) => { try { localStorage.setItem("endat-" + key, value); } catch { /* private window */ } };
const remembered = (key) => { try { return localStorage.getItem("endat-" + key); } catch { return null; } };

let card = null, now = null, plot = null;
// What became of something that was asked for; shown for a while.
let complaint = { text: "", until: 0 };
const view = { live: true, span: 10, from: 0, to: 1, show: "position", wrap: false, zero: {}, tab: "causes" };

async function ask(path, method, isText) {
  const response = await fetch(path, { method: method || "GET", signal: AbortSignal.timeout(30000) });
  const body = await response.text();
  if (isText && response.ok) return body;
  let told;
  try { told = JSON.parse(body); } catch { throw new Error(body.trim() || response.status); }
  if (told.error) throw new Error(told.error);
  return told;
}

function problem(text) {
  $("problem").hidden = !text;
  $("problem").textContent = text || "";
}

// ---- the card ----

const colour = (n) => getComputedStyle(document.documentElement).getPropertyValue("--c" + (n % 8)).trim();
const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();

function begin() {
  $("title").textContent = "EnDat card at " + card.port;
  document.title = card.port + " - EnDat";
  view.zero = {};
  const all = card.channels.map((channel, n) => {
    const box = make("article", undefined, "channel");
    const dial = svg("svg", { viewBox: "-50 -50 100 100", "aria-hidden": "true" });
    dial.append(svg("circle", { r: 42, class: "rim" }));
    for (let i = 0; i < 12; i++) {
      const a = i * Math.PI / 6, far = i % 3 ? 38 : 34;
      dial.append(svg("line", { x1: Math.sin(a) * far, y1: -Math.cos(a) * far, x2: Math.sin(a) * 42, y2: -Math.cos(a) * 42, class: "tick" }));
    }
    const hand = svg("line", { x1: 0, y1: 6, x2: 0, y2: -36, class: "hand" });
    hand.style.stroke = `var(--c${n % 8})`;
    dial.append(hand);
    // What goes to and fro, or tells no turn, has no dial.
    box.classList.toggle("plain", !channel.wraps_at);
    const head = make("h2", `Channel ${n}`), state = make("span", "", "pill");
    head.append(state);
    const value = make("div", "-", "value"), about = make("p", "", "about");
    box.append(dial, head, value, about);
    channel.box = { hand, state, value, about };
    return box;
  });
  $("channels").replaceChildren(...all);
  $("encoders").replaceChildren(...card.channels.map((channel, n) => {
    const box = make("div");
    box.append(make("h2", `Channel ${n}: ${channel.protocol}`), make("pre", (channel.plate || "the card does not read its name plate").replace(/^ {2}/gm, "")));
    return box;
  }));
  const canDiffer = card.traces.some((t) => t.name === "difference");
  document.querySelector('[data-show="difference"]').disabled = !canDiffer;
  if (view.show === "difference" && !canDiffer) view.show = "position";
  $("wrap").disabled = !card.channels.some((c) => c.wraps_at);
  margins();
  registers();
  pressed();
}

function fact(name, text, isWrong) {
  const box = make("div", undefined, isWrong ? "wrong" : "");
  box.append(make("dt", name), make("dd", text));
  return box;
}

// A position as it is shown: from the zero that was set, if one was.
function relative(channel, n, value) {
  const zero = view.zero[n];
  if (zero === undefined) return value;
  const off = now.channels[n].continuous === null ? null : now.channels[n].continuous - zero;
  return off;
}

function shown() {
  const old = !now.link || now.silent_s !== null || Boolean(now.error);
  const good = !old;
  $("link").textContent = good ? "live" : !now.link ? "connection lost" : now.silent_s === null ? "no samples" : `no samples for ${now.silent_s.toFixed(0)} s`;
  $("link").className = "pill " + (good ? "good" : "bad");
  problem(now.error || now.notice || (performance.now() < complaint.until && complaint.text));
  const count = (n) => n.toLocaleString("en");
  $("facts").replaceChildren(
    fact("rate", now.rate_hz === null ? "-" : `${count(Math.round(now.rate_hz))} /s`),
    fact("rows", count(now.rows)),
    fact("bad", count(now.bad), now.bad > 0),
    fact("missing", count(now.missing), now.missing > 0),
    fact("dropped in the card", count(now.dropped), now.dropped > 0),
    fact("damaged on the link", count(now.damaged), now.damaged > 0),
  );
  $("record").setAttribute("aria-pressed", String(now.recording !== null));
  $("record").textContent = now.recording ? "Stop" : "Record";
  $("recording").hidden = !now.recording;
  $("recording").textContent = now.recording ? `Recording: ${count(now.recording.rows)} rows in ${now.recording.path}` : "";
  now.channels.forEach((one, n) => {
    const channel = card.channels[n], box = channel.box;
    const isNone = one.value === null;
    const value = isNone ? null : relative(channel, n, one.value);
    box.value.replaceChildren(value === null ? "-" : value.toFixed(channel.digits), make("small", " " + channel.unit));
    box.value.classList.toggle("held", old || !one.fresh);
    box.hand.style.display = isNone || value === null || !channel.wraps_at ? "none" : "";
    if (channel.wraps_at) box.hand.setAttribute("transform", `rotate(${(value || 0) / channel.wraps_at * 360})`);
    const wrong = one.cause && one.cause !== "none";
    // One that brings nothing has a cause for that: the one that came most often.
    const most = Object.entries(one.counts).filter(([name]) => !NO_CAUSES.includes(name)).sort((a, b) => b[1] - a[1])[0];
    const why = NO_CAUSES.includes(one.cause) && most ? most[0] : one.cause;
    box.state.textContent = old ? "old" : one.fresh ? (wrong ? one.cause : "good") : one.cause === null ? "none yet" : `${isNone ? "none" : "held"}: ${why}`;
    box.state.className = "pill " + (old ? "bad" : one.fresh ? (wrong ? "warn" : "good") : "bad");
    const about = [];
    if (view.zero[n] !== undefined) about.push("from the zero that was set");
    else if (one.turns) about.push(`${one.turns} turns`);
    if (channel.unknown) about.push("length of a turn unknown: view --range");
    if (one.raw !== null) about.push("0x" + one.raw);
    if (!isNone && one.delay_ns !== null && channel.protocol === "EnDat") about.push(`line delay ${one.delay_ns.toFixed(0)} ns`, `recovery time ${one.recovery_us.toFixed(2)} us`);
    if (channel.serial) about.push("serial number " + channel.serial);
    box.about.textContent = about.join(", ");
  });
  causes();
}

function causes() {
  if (view.tab !== "causes") return;
  const rows = now.channels.flatMap((one, n) => Object.entries(one.counts).map(([name, count]) => ({ n, name, count })));
  if (!rows.length) { $("causes").replaceChildren(make("p", "Nothing was wrong since this card was found.", "note")); return; }
  const table = make("table"), head = make("tr");
  for (const text of ["channel", "cause", "times", "what it means", "what helps"]) head.append(make("th", text));
  table.append(head);
  for (const { n, name, count } of rows) {
    const line = make("tr"), [means, helps] = card.causes[name] || ["", ""];
    line.append(make("td", n), make("td", name), make("td", count.toLocaleString("en"), "number"), make("td", means), make("td", helps));
    table.append(line);
  }
  $("causes").replaceChildren(table);
}

// ---- the plot ----

const PAD = { left: 74, right: 14, top: 10, bottom: 26 };
// As high as its letters.
const LANE = 15;
// No green: nothing here is good.
const MARKS = ["#d32f2f", "#f57c00", "#8e24aa", "#c2185b", "#8d6e63", "#fbc02d", "#ff7043", "#ad1457"];
const NO_RESULT = "#78909c";
const NO_CAUSES = ["not_taken", "too_late", "late"];
// In the order in which they come, so that the first eight differ.
const markOfCause = new Map();
function markOf(name) {
  if (NO_CAUSES.includes(name)) return NO_RESULT;
  if (!markOfCause.has(name)) markOfCause.set(name, MARKS[markOfCause.size % MARKS.length]);
  return markOfCause.get(name);
}
let pointer = null;

function wanted() {
  if (view.show === "difference") return ["difference"];
  return card.channels.map((_, n) => view.show + n);
}

function window_() {
  const [first, last] = now.span_s || [0, 1];
  if (!view.live) return [view.from, view.to];
  const span = view.span === "all" ? Math.max(last - first, 1e-3) : view.span;
  // Not before the first row: a card that has just begun fills the drawing, too.
  return [Math.max(first, last - span), Math.max(last, first + 1e-3)];
}

let busy = false, again = false, rowsPerSecond = 1;
async function redraw() {
  if (!card || !now) return;
  if (busy) { again = true; return; }
  busy = true;
  try {
    const [from, to] = window_();
    const width = Math.max(50, Math.floor($("plot").clientWidth - PAD.left - PAD.right));
    // A bucket for each row where rows are few.
    if (now.rows_hz) rowsPerSecond = now.rows_hz;
    const rows = Math.ceil((to - from) * rowsPerSecond);
    const buckets = Math.max(2, Math.min(width, rows, 4000));
    const told = await ask(`/api/plot?from=${from}&to=${to}&buckets=${buckets}&traces=${wanted().join(",")}`);
    if (told.session === card.session) { plot = told; draw(); }
  } catch { /* the next poll says what is wrong */ } finally {
    busy = false;
    if (again) { again = false; redraw(); }
  }
}

function nice(span, count) {
  const raw = span / count, power = 10 ** Math.floor(Math.log10(raw));
  return power * [1, 2, 5, 10].find((f) => f * power >= raw);
}

// Least and greatest value of a bucket as they are drawn.
function ends(trace, name, i) {
  let low = trace.min[i], high = trace.max[i];
  if (low === null) return null;
  const position = /^position(\d)$/.exec(name);
  if (position) {
    const n = Number(position[1]), turn = card.channels[n].wraps_at;
    const zero = view.zero[n] || 0;
    [low, high] = [low - zero, high - zero];
    if (view.wrap && turn) {
      const turns = Math.floor(low / turn);
      [low, high] = Math.floor(high / turn) === turns ? [low - turns * turn, high - turns * turn] : [0, turn];
    }
  }
  return [low, high];
}

// Draws the lines of one unit with their axis; how many digits its numbers have.
function drawn(pen, box, lines, x, middle) {
  const all = lines.flatMap((l) => l.points).filter(Boolean);
  let low = Math.min(...all.map((p) => p[0])), high = Math.max(...all.map((p) => p[1]));
  if (!all.length) [low, high] = [0, 1];
  const room = Math.max((high - low) * .05, Math.abs(high) * 1e-9, 1e-9);
  [low, high] = [low - room, high + room];
  const y = (v) => box.y + (high - v) / (high - low) * box.h;
  pen.strokeStyle = ink("line"); pen.fillStyle = ink("quiet"); pen.lineWidth = 1;
  pen.textAlign = "right"; pen.textBaseline = "middle";
  const step = nice(high - low, Math.max(2, box.h / 55)), digits = Math.max(0, Math.min(10, -Math.floor(Math.log10(step))));
  for (let v = Math.ceil(low / step) * step; v <= high; v += step) {
    pen.beginPath(); pen.moveTo(box.x, y(v)); pen.lineTo(box.x + box.w, y(v)); pen.stroke();
    pen.fillText(v.toFixed(digits), box.x - 6, y(v));
  }
  pen.save(); pen.beginPath(); pen.rect(box.x, box.y, box.w, box.h); pen.clip();
  for (const { name, points } of lines) {
    const n = Number(/\d/.exec(name) || 0), turn = card.channels[n].wraps_at;
    pen.strokeStyle = pen.fillStyle = colour(n); pen.lineWidth = 1.4; pen.lineJoin = "round";
    const areas = [[]];
    let empty = 0;
    points.forEach((point, i) => {
      if (!point) { empty++; return; }
      const area = areas[areas.length - 1], last = area[area.length - 1];
      const jumps = last && view.wrap && turn && view.show === "position" && Math.abs(point[0] - last[1]) > turn / 2;
      // Rows and buckets do not fall together: one empty bucket is no hole.
      if (last && (empty > 1 || jumps)) areas.push([]);
      areas[areas.length - 1].push([x(middle(i)), point[0], point[1]]);
      empty = 0;
    });
    for (const area of areas.filter((a) => a.length)) {
      pen.beginPath();
      area.forEach(([at, , top], i) => i ? pen.lineTo(at, y(top)) : pen.moveTo(at, y(top)));
      [...area].reverse().forEach(([at, bottom]) => pen.lineTo(at, y(bottom)));
      pen.closePath();
      pen.globalAlpha = .35; pen.fill(); pen.globalAlpha = 1; pen.stroke();
      if (area.length === 1) pen.fillRect(area[0][0] - 1, y(area[0][2]) - 1, 2, y(area[0][1]) - y(area[0][2]) + 2);
    }
  }
  pen.restore();
  pen.textAlign = "left"; pen.textBaseline = "top";
  let at = box.x + 6;
  for (const { name, unit } of lines) {
    const n = Number(/\d/.exec(name) || 0), text = name === "difference" ? `channel 0 less channel 1 (${unit})` : `channel ${n} (${unit})`;
    pen.fillStyle = colour(n); pen.fillText(text, at, box.y + 4); at += pen.measureText(text).width + 16;
  }
  return digits;
}

// What the colours of the lanes are.
function legend(names) {
  const told = names.join();
  if ($("legend").dataset.told === told) return;
  $("legend").dataset.told = told;
  $("legend").replaceChildren(...names.map((name) => {
    const item = make("span", name), mark = make("i", "");
    mark.style.background = markOf(name);
    item.prepend(mark);
    return item;
  }));
}

function draw() {
  const canvas = $("plot"), ratio = devicePixelRatio || 1;
  const width = canvas.clientWidth, height = canvas.clientHeight;
  canvas.width = width * ratio; canvas.height = height * ratio;
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.font = "12px system-ui, 'DejaVu Sans', sans-serif";
  const lanes = card.channels.length * LANE + 6;
  const box = { x: PAD.left, y: PAD.top, w: width - PAD.left - PAD.right, h: height - PAD.top - PAD.bottom - lanes };
  const span = plot.to - plot.from, x = (t) => box.x + (t - plot.from) / span * box.w;
  const middle = (i) => plot.from + (i + .5) / plot.buckets * span;
  const unitOf = (name) => card.traces.find((t) => t.name === name).unit;
  const lines = Object.entries(plot.traces).map(([name, trace]) => ({ name, unit: unitOf(name), points: trace.min.map((_, i) => ends(trace, name, i)) }));
  // What has another unit has another axis.
  const units = [...new Set(lines.map((l) => l.unit))];
  const each = box.h / units.length;
  pen.textBaseline = "top";
  const tick = nice(span, Math.max(2, box.w / 110)), small = Math.max(0, Math.min(9, -Math.floor(Math.log10(tick))));
  pen.strokeStyle = ink("line"); pen.fillStyle = ink("quiet"); pen.lineWidth = 1; pen.textAlign = "center";
  for (let t = Math.ceil(plot.from / tick) * tick; t <= plot.to; t += tick) {
    pen.beginPath(); pen.moveTo(x(t), box.y); pen.lineTo(x(t), box.y + box.h); pen.stroke();
    if (x(t) < width - 24) pen.fillText(t.toFixed(small) + " s", x(t), height - PAD.bottom + 6);
  }
  let digits = 0;
  units.forEach((unit, k) => {
    const panel = { x: box.x, w: box.w, y: box.y + k * each, h: each - (k + 1 < units.length ? 8 : 0) };
    digits = Math.max(digits, drawn(pen, panel, lines.filter((l) => l.unit === unit), x, middle));
  });
  // Causes, a lane for each channel.
  const under = box.y + box.h + 4;
  plot.causes.forEach((marks, n) => {
    pen.fillStyle = ink("paper"); pen.fillRect(box.x, under + n * LANE, box.w, LANE - 2);
    const marked = new Set(marks.map(([i]) => i));
    for (const [i, names] of marks) {
      const isLong = i + 1 < plot.buckets && !marked.has(i + 1) && lines.every((l) => !l.points[i + 1]);
      names.forEach((name, k) => {
        pen.fillStyle = markOf(name);
        const part = (LANE - 2) / names.length;
        pen.fillRect(x(plot.from + i / plot.buckets * span), under + n * LANE + k * part, Math.max(2, box.w / plot.buckets * (isLong ? 2 : 1)), part);
      });
    }
    pen.fillStyle = ink("quiet"); pen.textAlign = "right"; pen.textBaseline = "middle";
    pen.fillText("causes " + n, box.x - 6, under + n * LANE + LANE / 2);
  });
  legend([...new Set(plot.causes.flat().flatMap(([, names]) => names))]);
  if (pointer !== null && pointer >= box.x && pointer <= box.x + box.w) {
    pen.strokeStyle = ink("ink"); pen.beginPath(); pen.moveTo(pointer, box.y); pen.lineTo(pointer, under + lanes - 6); pen.stroke();
    const i = Math.min(plot.buckets - 1, Math.floor((pointer - box.x) / box.w * plot.buckets));
    const texts = lines.map(({ name, unit, points }) => {
      const point = points[i], n = /\d/.exec(name), label = n ? `channel ${n[0]}` : name;
      const precise = Math.min(10, digits + 2);
      return point ? `${label}: ${point[0] === point[1] ? point[0].toFixed(precise) : point[0].toFixed(precise) + " to " + point[1].toFixed(precise)} ${unit}` : `${label}: nothing`;
    });
    const marks = plot.causes.flatMap((all, n) => all.filter(([k]) => k === i).map(([, names]) => `channel ${n}: ${names.join(", ")}`));
    $("cursor").textContent = [`${middle(i).toFixed(Math.min(9, small + 2))} s`, ...texts, ...marks].join("; ");
  }
  canvas.setAttribute("aria-label", `${view.show} over time, from ${plot.from.toFixed(3)} s to ${plot.to.toFixed(3)} s`);
}

function look(from, to) {
  const [first, last] = now.span_s || [0, 1];
  const span = Math.min(Math.max(to - from, 1e-4), Math.max(last - first, 1e-3) * 1.2);
  const middle = Math.min(Math.max((from + to) / 2, first), last);
  Object.assign(view, { live: false, from: middle - span / 2, to: middle + span / 2 });
  pressed(); redraw();
}

function zoom(factor, at) {
  const [from, to] = window_(), c = at === undefined ? (from + to) / 2 : at;
  look(c + (from - c) * factor, c + (to - c) * factor);
}

function pan(share) {
  const [from, to] = window_(), by = (to - from) * share;
  look(from + by, to + by);
}

function live(span) {
  view.live = true;
  if (span !== undefined) view.span = span;
  pressed(); redraw();
}

function show(what) {
  if (document.querySelector(`[data-show="${what}"]`).disabled) return;
  view.show = what;
  pressed(); redraw();
}

function zero() {
  const unknown = card.channels.find((channel) => channel.unknown);
  if (unknown) complaint = { text: "zero: " + unknown.unknown, until: performance.now() + 10000 };
  now.channels.forEach((one, n) => { if (one.continuous !== null && !card.channels[n].unknown) view.zero[n] = one.continuous; });
  shown(); redraw();
}

function pressed() {
  const set = (button, on) => button.setAttribute("aria-pressed", String(on));
  document.querySelectorAll("[data-show]").forEach((b) => set(b, b.dataset.show === view.show));
  document.querySelectorAll("[data-span]").forEach((b) => set(b, view.live && b.dataset.span === String(view.span)));
  set($("live"), view.live); set($("wrap"), view.wrap);
  document.querySelectorAll("[data-tab]").forEach((b) => {
    b.setAttribute("aria-selected", String(b.dataset.tab === view.tab));
    $(b.dataset.tab).hidden = b.dataset.tab !== view.tab;
  });
}

// ---- what else there is ----

function margins() {
  const has = card.parts.includes("margin");
  if (!has) { $("margin").replaceChildren(make("p", "This card does not measure its margin: [line] parts = [\"alignment\", \"margin\"]", "note")); return; }
  $("margin").replaceChildren(...card.channels.flatMap((channel, n) => {
    if (channel.protocol !== "EnDat") return [];
    const figure = make("figure");
    figure.dataset.channel = n;
    return [figure];
  }));
}

// A drawing as a part of the page, in the page's colours.
function drawing(text) {
  // Its own style is that of a file: here it may not even be read.
  const told = new DOMParser().parseFromString(text.replace(/<style>[^<]*<\/style>/, ""), "image/svg+xml").documentElement;
  const picture = svg("svg", { role: "img", "aria-label": told.querySelector("title").textContent });
  const caption = make("figcaption");
  // Nor is its white paper of use, which has no class.
  for (const part of [...told.children].filter((c) => c.classList.length)) {
    // Letters in a drawing do not wrap: sentences stand above it.
    const isSentence = part.getAttribute("text-anchor") === "start" && part.textContent.includes(" ");
    if (isSentence) caption.append(make(part.classList.contains("title") ? "h2" : "p", part.textContent));
    else picture.append(document.importNode(part, true));
  }
  return [caption, picture];
}

// As large as what is in it: letters are larger on a phone.
function cropped(picture) {
  const box = picture.getBBox();
  if (box.width) picture.setAttribute("viewBox", [box.x - 4, box.y - 4, box.width + 8, box.height + 8].join(" "));
}

async function margin(figure) {
  try {
    const told = await ask("/api/margin.svg?channel=" + figure.dataset.channel, "GET", true);
    // What is not shown has no size.
    if (view.tab !== "margin") return;
    const [caption, picture] = drawing(told);
    figure.replaceChildren(caption, picture);
    cropped(picture);
  } catch (error) { figure.replaceChildren(make("p", error.message, "note")); }
}

function marginsNow() {
  if (view.tab !== "margin" || document.hidden) return;
  document.querySelectorAll("#margin svg").forEach(cropped);
  document.querySelectorAll("#margin figure").forEach(margin);
}

let names = [];
async function registers() {
  names = await ask("/api/registers");
  listed();
}

function listed() {
  const words = $("register-search").value.toLowerCase().split(/\s+/).filter(Boolean);
  // A field is looked for by its name, with that of its register before it or not, and by its meaning.
  const has = (text) => words.every((w) => text.toLowerCase().includes(w));
  const found = names.map((r) => [r, words.length ? r.fields.filter(([name, means]) => has(`${r.name}.${name} ${means} ${r.meaning}`)) : []])
    .filter(([r, fields]) => has(r.name + " " + r.meaning) || fields.length).slice(0, 200);
  $("register-list").replaceChildren(...found.map(([r, fields]) => {
    const line = make("li"), button = make("button", r.name);
    button.type = "button";
    button.addEventListener("click", () => register(r));
    line.append(button, ` ${r.access}: ${r.meaning}`);
    if (fields.length && !has(r.name + " " + r.meaning)) {
      const list = make("ul");
      list.append(...fields.map(([name, means]) => make("li", `${name}: ${means}`)));
      line.append(list);
    }
    return line;
  }));
}

async function register(r) {
  const out = $("register-value");
  try {
    const told = await ask("/api/register?name=" + encodeURIComponent(r.name));
    const table = make("table"), head = make("tr");
    head.append(make("th", told.name), make("th", `0x${told.value.toString(16).toUpperCase().padStart(8, "0")}`), make("th", ""));
    table.append(head);
    for (const [name, field] of Object.entries(told.fields)) {
      const line = make("tr");
      line.append(make("td", name), make("td", `${field.value} ${field.unit}`), make("td", field.meaning || ""));
      table.append(line);
    }
    out.replaceChildren(table);
  } catch (error) { out.replaceChildren(make("p", error.message, "note")); }
}

async function parameter(event) {
  event.preventDefault();
  const out = $("parameter-value");
  out.textContent = "...";
  try {
    const told = await ask("/api/parameter?" + new URLSearchParams(new FormData($("parameter"))), "POST");
    out.textContent = `0x${told.value.toString(16).toUpperCase().padStart(4, "0")} = ${told.value}`;
  } catch (error) { out.textContent = error.message; }
}

// A virtual card takes faults; what each is stands below.
function faults() {
  document.querySelector("[data-tab=rehearsal]").hidden = card.faults.length === 0;
  const select = $("inject").elements.fault;
  select.replaceChildren(...card.faults.map(([name]) => make("option", name)));
  faultIs();
}

function faultIs() {
  const fault = card.faults.find(([name]) => name === $("inject").elements.fault.value);
  $("inject-is").textContent = fault ? `${fault[0]} ${fault[1]}: ${fault[2]}` : "";
}

async function inject(event) {
  event.preventDefault();
  const out = $("inject-done");
  out.textContent = "...";
  try {
    out.textContent = (await ask("/api/inject?" + new URLSearchParams(new FormData($("inject"))), "POST")).done;
  } catch (error) { out.textContent = error.message; }
}

async function record() {
  try { await ask(now && now.recording ? "/api/stop" : "/api/record", "POST"); } catch (error) {
    complaint = { text: error.message, until: performance.now() + 10000 };
    problem(error.message);
    return;
  }
  poll();
}

function theme() {
  const dark = getComputedStyle(document.documentElement).colorScheme === "dark"
    || (!document.documentElement.dataset.theme && matchMedia("(prefers-color-scheme: dark)").matches);
  document.documentElement.dataset.theme = dark ? "light" : "dark";
  remember("theme", document.documentElement.dataset.theme);
  if (plot) draw();
}

// ---- events ----

document.querySelectorAll("[data-show]").forEach((b) => b.addEventListener("click", () => show(b.dataset.show)));
document.querySelectorAll("[data-span]").forEach((b) => b.addEventListener("click", () => live(b.dataset.span === "all" ? "all" : Number(b.dataset.span))));
document.querySelectorAll("[data-tab]").forEach((b) => b.addEventListener("click", () => { view.tab = b.dataset.tab; pressed(); if (now) causes(); marginsNow(); }));
$("live").addEventListener("click", () => live());
$("wrap").addEventListener("click", () => { view.wrap = !view.wrap; pressed(); redraw(); });
$("zero").addEventListener("click", zero);
$("unzero").addEventListener("click", () => { view.zero = {}; shown(); redraw(); });
$("record").addEventListener("click", record);
$("theme").addEventListener("click", theme);
$("register-search").addEventListener("input", listed);
$("parameter").addEventListener("submit", parameter);
$("inject").addEventListener("submit", inject);
$("inject").elements.fault.addEventListener("change", faultIs);

const KEYS = {
  p: () => show("position"), v: () => show("velocity"), d: () => show("difference"), l: () => live(), a: () => live("all"),
  w: () => $("wrap").click(), z: zero, x: () => $("unzero").click(), r: record, t: theme,
  ArrowLeft: () => pan(-.25), ArrowRight: () => pan(.25), "+": () => zoom(.5), "=": () => zoom(.5), "-": () => zoom(2),
};
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|TEXTAREA)$/.test(event.target.tagName) || !card || !now) return;
  const act = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (act) { event.preventDefault(); act(); }
});

const canvas = $("plot"), touches = new Map();
const timeAt = (x) => { const [from, to] = window_(); return from + (x - PAD.left) / (canvas.clientWidth - PAD.left - PAD.right) * (to - from); };
canvas.addEventListener("wheel", (event) => { event.preventDefault(); if (now) zoom(event.deltaY > 0 ? 1.25 : .8, timeAt(event.offsetX)); }, { passive: false });
canvas.addEventListener("dblclick", () => live());
canvas.addEventListener("pointerdown", (event) => { touches.set(event.pointerId, event.offsetX); canvas.setPointerCapture(event.pointerId); });
for (const over of ["pointerup", "pointercancel"]) canvas.addEventListener(over, (event) => touches.delete(event.pointerId));
canvas.addEventListener("pointerleave", () => { pointer = null; if (plot) draw(); });
canvas.addEventListener("pointermove", (event) => {
  pointer = event.offsetX;
  const before = touches.get(event.pointerId);
  if (before !== undefined && now) {
    const others = [...touches].filter(([id]) => id !== event.pointerId);
    touches.set(event.pointerId, event.offsetX);
    if (others.length) {
      const other = others[0][1], was = Math.abs(before - other), is = Math.abs(event.offsetX - other);
      if (was > 8 && is > 8) zoom(was / is, timeAt((event.offsetX + other) / 2));
    } else if (event.offsetX !== before) {
      pan((before - event.offsetX) / (canvas.clientWidth - PAD.left - PAD.right));
    }
  }
  if (plot) draw();
});
addEventListener("resize", () => { if (plot) redraw(); document.querySelectorAll("#margin svg").forEach(cropped); });
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { if (plot) draw(); });

// ---- polling ----

async function poll() {
  try {
    const told = await ask("/api/now");
    if (!card || told.session !== card.session) {
      card = await ask("/api/card");
      plot = null; now = told;
      begin();
      faults();
      live();
    }
    now = told;
    shown();
    if (view.live) redraw();
  } catch (error) {
    $("link").textContent = "no answer";
    $("link").className = "pill bad";
    if (card) for (const { box } of card.channels) {
      box.state.textContent = "old";
      box.state.className = "pill bad";
      box.value.classList.add("held");
    }
    problem(error instanceof TypeError || error.name === "TimeoutError" ? "The program that serves this page does not answer; trying again." : error.message);
  }
}

async function forever() {
  for (;;) {
    await poll();
    await new Promise((go) => setTimeout(go, document.hidden ? 2000 : 120));
  }
}

const kept = remembered("theme");
if (kept) document.documentElement.dataset.theme = kept;
pressed();
setInterval(marginsNow, 2000);
forever();
