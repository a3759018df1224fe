// The page: sliders ask, answers are drawn. A question of a moving hand waits for the one before; one of a resting hand gives way to any newer.
const setup = JSON.parse($("setup").textContent), ask = backend(), view = spaceView($("space"), {glass: 0.62, near: 0.95, shape: [0.68, 0.6]}), body = setup.scaled ? null : turningView();
const touched = {}, fields = {}, torque = setup.groups.find(group => group.axis);
let axis = torque ? torque.axis : null, axisTouched = false, linked = "", shown = null, serial = 0, latest = 0, busy = false, waiting = null, resting = null, abort = null, cross = null, planeArt = null, timeArt = null;
const REST = 160;  // ms without a change after which a hand rests

function element(tag, properties, ...children) { const made = Object.assign(document.createElement(tag), properties); made.append(...children); return made; }

function put(name, text) {  // a number on its slider and in its field
  const {range, field, row} = fields[name], value = Number(text);
  if (value > Number(range.max)) range.max = value;
  if (value < Number(range.min)) range.min = value;
  range.value = value; field.value = text; row.classList.toggle("own", !(name in touched));
}

function slider(title, control) {
  const name = control.name, range = element("input", {type: "range", id: name, min: control.low, max: control.high, step: "any", value: control.value});
  const field = element("input", {type: "number", step: "any", value: control.value}), unit = control.unit && `, ${control.unit}`;
  const label = element("label", {htmlFor: name}), row = element("div", {className: "control own"}, label, range, field, element("span", {className: "unit", textContent: control.unit}));
  const called = name => { const words = name.replace(/^the | axis$/g, ""); label.textContent = words; range.setAttribute("aria-label", `${title}: ${words}${unit}`); field.setAttribute("aria-label", `${title}: ${words}${unit}, as a number`); };
  called(control.words || setup.axes[control.axis - 1]);
  if (control.axis) range.style.accentColor = INK.components[control.axis - 1];
  const step = 10 ** Math.floor(Math.log10((control.high - control.low) / 500));
  range.oninput = () => { linked = ""; touched[name] = String(+(Math.round(Number(range.value) / step) * step).toPrecision(9)); put(name, touched[name]); move(); };
  field.oninput = () => { if (field.value === "" || !Number.isFinite(Number(field.value))) return; linked = ""; touched[name] = field.value; put(name, field.value); move(); };
  fields[name] = {range, field, row, called, axis: control.axis, own: String(control.value), low: control.low, high: control.high};
  return row;
}

function build() {
  for (const group of setup.groups) {
    const set = element("fieldset", {}, element("legend", {textContent: group.title}));
    if (group === torque) {
      const choice = element("select", {id: "axis"}, ...setup.axes.map((name, n) => element("option", {value: n + 1, textContent: name})));
      choice.setAttribute("aria-label", "The axis that the torque is along"); choice.value = axis;
      choice.onchange = () => { linked = ""; axis = Number(choice.value); axisTouched = true; move(); };
      set.append(element("div", {className: "control"}, element("label", {htmlFor: "axis", textContent: "axis"}), choice));
    }
    set.append(...group.controls.map(one => slider(group.title, one))); $("controls").append(set);
  }
  const button = (id, textContent) => element("button", {type: "button", id, textContent}), again = button("again", "As in the case"), save = button("save", "Save as case"), copy = button("copy", "Copy link");
  again.onclick = () => { asInCase(); shown = null; move(); };
  copy.onclick = async () => {
    remember();
    try { await navigator.clipboard.writeText(location.href); copy.textContent = "Copied"; setTimeout(() => { copy.textContent = "Copy link"; }, 1500); }
    catch { trouble("This browser gives no access to its clipboard: copy the address of this page, which holds the state"); }
  };
  save.onclick = () => {
    if (!shown || !shown.toml) return;
    const link = element("a", {href: URL.createObjectURL(new Blob([shown.toml], {type: "application/toml"})), download: `${setup.name}-explored.toml`});
    document.body.append(link); link.click(); link.remove(); setTimeout(() => URL.revokeObjectURL(link.href), 5000);
  };
  $("controls").append(element("div", {className: "buttons"}, save, again, copy)); $("controls").onsubmit = e => e.preventDefault();
  document.querySelectorAll(".picture").forEach(part => {
    const tab = element("button", {type: "button", textContent: part.dataset.tab});
    tab.onclick = () => { pick(part, tab); drawFlat(); view.draw(); if (body) body.draw(); };
    document.querySelector(".tabs").append(tab); if (part.matches(".curves")) pick(part, tab);
  });
}

function pick(part, tab) {  // on a telephone one picture stands above the sliders
  document.querySelectorAll(".picture").forEach(one => one.classList.toggle("picked", one === part));
  tab.parentNode.querySelectorAll("button").forEach(one => one.setAttribute("aria-pressed", one === tab));
}

function asInCase() {
  for (const name of Object.keys(touched)) delete touched[name];
  linked = ""; axisTouched = false;
  if (torque) { axis = torque.axis; $("axis").value = axis; }
  for (const [name, {range, low, high, own}] of Object.entries(fields)) { range.min = low; range.max = high; put(name, own); }
}

// The state stands in the address behind #: what the sliders changed, by the names of the sliders.
function remember() {
  const state = new URLSearchParams({...(axisTouched ? {axis} : {}), ...touched}).toString();
  history.replaceState(null, "", state ? `#${state}` : location.pathname + location.search);
}

function restore() {
  asInCase();
  const wrong = [];
  for (const [name, text] of new URLSearchParams(location.hash.slice(1))) {
    if (torque && name === "axis" && ["1", "2", "3"].includes(text)) { axis = Number(text); axisTouched = true; $("axis").value = axis; }
    else if (Object.hasOwn(fields, name) && text.trim() && Number.isFinite(Number(text))) { touched[name] = text.trim(); put(name, text.trim()); }
    else wrong.push(text ? `${name.slice(0, 20)}=${text.slice(0, 20)}` : name.slice(0, 20));
  }
  if (wrong.length) linked = `Left out of the link: ${wrong.slice(0, 5).join(", ")}${wrong.length > 5 ? " and more" : ""}; expected a number for any of ${Object.keys(fields).join(", ")}${torque ? ", and 1, 2 or 3 for axis" : ""}.`;
}

function question(moving, click) {
  const row = stem => { const names = Object.keys(fields).filter(name => name.startsWith(stem)); return names.length ? names.map(name => touched[name] ?? null) : null; }, value = name => touched[name] ?? fields[name].own;
  const turned = axisTouched || ["size", "tilt", "azimuth"].some(name => name in touched);
  const along = row("torque"), acting = !torque ? along && along.some(one => one !== null) ? {file: along} : null : turned ? {axis, size: value("size"), tilt: value("tilt"), azimuth: value("azimuth")} : null;
  return {torque: acting, inertia: row("inertia"), wheel: row("wheel"),
          start: row("start"), moving, click: click || null, box: shown && shown.space ? shown.space.box : null};
}

function move(click) {
  clearTimeout(resting); resting = setTimeout(rest, REST);
  waiting = {click}; if (!busy) pump();
}

function rest() {  // a click is answered first: its start is part of every question after it
  if (busy || waiting) resting = setTimeout(rest, REST); else { remember(); send(false); }
}

async function pump() {
  busy = true;
  while (waiting) { const {click} = waiting; waiting = null; await send(true, click); }
  busy = false;
}

async function send(moving, click) {
  const number = ++serial, began = performance.now();
  if (abort) abort.abort();
  abort = moving ? null : new AbortController();
  try {
    const reply = await ask("answer", {...question(moving, click), serial: number}, abort && abort.signal);
    if (reply === null || number < latest) return;
    const answer = unpacked(reply); latest = number;
    if (answer.start) answer.start.forEach((text, n) => { touched[`start${n}`] = text; put(`start${n}`, text); });
    const answered = performance.now();
    show(answer);
    if (!answer.error) $("work").textContent = `Answered in ${Math.round(answered - began)} ms, of which the analysis took ${answer.analysis.toFixed(1)} ms; drawn in ${Math.round(performance.now() - answered)} ms.`;
  } catch (error) { if (error.name !== "AbortError") trouble(error.message); }
}

function unpacked(reply) {
  const length = new DataView(reply).getUint32(0, true), header = JSON.parse(new TextDecoder().decode(new Uint8Array(reply, 4, length))), from = Math.ceil((4 + length) / 4) * 4;
  const kinds = {int16: Int16Array, float32: Float32Array};
  const filled = value => {
    if (Array.isArray(value)) return value.map(filled);
    if (value && typeof value === "object") return value.type in kinds && "count" in value ? new kinds[value.type](reply, from + value.from, value.count)
      : Object.fromEntries(Object.entries(value).map(([key, one]) => [key, filled(one)]));
    return value;
  };
  return filled(header);
}

function fill(id, told, children) {  // what says the same as before stays, and is not painted anew
  const place = $(id), key = JSON.stringify(told);
  if (place.dataset.told === key) return;
  place.dataset.told = key; place.replaceChildren(...children(told));
}

const SUPER = {"-": "\u207b", 0: "\u2070", 1: "\u00b9", 2: "\u00b2", 3: "\u00b3", 4: "\u2074", 5: "\u2075", 6: "\u2076", 7: "\u2077", 8: "\u2078", 9: "\u2079"};
const powers = words => words.replace(/(?<=\d)e([+-]?)0*(\d+)(?!\w)/g, (_, sign, power) => ` \u00d7 10${[...(sign === "-" ? sign : "") + power].map(one => SUPER[one]).join("")}`);
const signed = words => powers(words).replace(/(^|[\s(\[=,])-(?=[\p{L}\d(])/gu, "$1\u2212").replace(/(?<=[\p{L}\d)²³]) - (?=[\p{L}\d(])/gu, " \u2212 ").replace(/(?<=[\p{L}\d)]) \. (?=[\p{L}(])/gu, " · ").replace(/(?<=[MHωλγ])\.(?=[(MHDωλγ])/g, "·").replace(/\^([23T])(?!\w)/g, (_, one) => ({2: "²", 3: "³", T: "ᵀ"})[one]);
function trouble(words) { $("note").className = "warning"; $("note").hidden = !words; $("note").textContent = words; $("headline").classList.toggle("stale", Boolean(words)); }

function show(answer) {
  if (answer.error) { trouble(answer.error); return; }
  const note = [linked, answer.note].filter(Boolean).join(" ");
  trouble(note); $("headline").classList.remove("stale"); shown = answer;
  $("note").className = note.startsWith("Within") ? "note" : "warning";  // a law that holds is no warning
  for (const {axis, called} of Object.values(fields)) if (axis) called(answer.axes[axis - 1]);
  if (torque) [...$("axis").options].forEach((option, n) => { option.textContent = answer.axes[n]; });
  $("headline").replaceChildren(answer.first, ...answer.small ? [" ", element("span", {className: "below", textContent: answer.small})] : []);
  $("headline").className = `verdict-line ${answer.look}`;
  view.show(answer.space);
  fill("legend", answer.space.legend, rows => rows.map(([words, colour]) => { const mark = element("i", {}); mark.style.background = colour; return element("span", {}, mark, words); }));
  fill("space-words", `${answer.space.words}. Drag to turn; click a curve or a point to start there; double click: as at first.`, words => [signed(words)]);
  if (answer.film) { body.show(answer.film); fill("body-words", answer.film.words, words => [signed(words)]); }
  else if (body) fill("body-words", answer.moving ? "Keep still, and the body turns." : "The body turns where NumPy is there.", words => [words]);
  drawFlat();
  const saddle = answer.plane && answer.plane.rests.some(one => one.saddle), centre = answer.plane && answer.plane.rests.some(one => !one.saddle);
  fill("plane-words", answer.plane ? `Violet: this motion;${saddle ? " black: separatrix;" : ""} grey: other energies${centre ? "; filled: centre" : ""}${saddle ? "; open: saddle" : ""}. Click to start a motion there.`
    : "This scene does not reduce to one degree of freedom, so it has no phase plane.", words => [signed(words)]);
  const limited = answer.time.limits.length ? `Dashed: ${answer.time.assumed ? "assumed limit" : "limit"}` + (answer.time.reached === null ? "." : Array.isArray(answer.time.reached) ? ", reached between the upright lines." : ", reached at the upright line.") : "";
  const told = [limited, answer.time.extremes ? "Dotted: least and greatest for ever." : "", periods(answer.time).length ? "Grey: whole periods." : ""].join(" ").trim();
  fill("time-words", [answer.time.names, told], ([names, words]) => [...names.map((name, n) => {
    const mark = element("span", {textContent: `${name} `}); mark.style.color = INK.components[n] || INK.size; mark.style.fontWeight = 600; return mark; }), words]);
  fill("facts", answer.rows, rows => rows.flatMap(([words, value]) => [element("dt", {textContent: words}), element("dd", {textContent: signed(value)})]));
  fill("equilibria-words", answer.equilibria.reason, words => [signed(words)]);
  fill("equilibria", answer.equilibria.rows, rows => rows.map(row => element("tr", {}, ...row.map(text => element("td", {textContent: signed(text)})))));
  document.documentElement.dataset.answers = latest; document.documentElement.dataset.moving = answer.moving;
}

function drawFlat() {
  if (!shown) return;
  timeArt = drawTime($("time"), shown.time);
  $("plane").hidden = !shown.plane;
  if (shown.plane) planeArt = drawPlane($("plane"), shown.plane, document.activeElement === $("plane") ? cross : null);
  else planeArt = null;
}

if (body) body.moved = t => { if (timeArt) { $("cursor").hidden = !shown.film; $("cursor").style.left = `${timeArt.x(t) + 1}px`; } };
new ResizeObserver(() => document.documentElement.style.setProperty("--top", `${$("headline").offsetHeight + 6}px`)).observe($("headline"));
document.querySelector(".skip").onclick = e => { e.preventDefault(); $("controls").focus(); };  // what stands behind # is the state
window.addEventListener("hashchange", () => { restore(); shown = null; move(); });
$("plane").onclick = e => { if (!planeArt) return; const [turn, rate] = planeArt.at(e.offsetX, e.offsetY); cross = null; move({turn, rate}); };
$("plane").onkeydown = e => {
  const way = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[e.key];
  if (!planeArt || !way && e.key !== "Enter") return;
  e.preventDefault(); cross = cross || [...planeArt.start];
  const [first, last, low, high] = planeArt.span;
  if (way) { cross[0] += way[0] * Math.abs(last - first) / 60; cross[1] += way[1] * (high - low) / 60; drawFlat(); }
  else { const [turn, rate] = cross; cross = null; move({turn, rate}); }
};
$("plane").onblur = () => { cross = null; drawFlat(); };
view.onpick = place => { linked = ""; place.forEach((v, n) => { touched[`start${n}`] = String(+v.toPrecision(7)); put(`start${n}`, touched[`start${n}`]); }); move(); };
window.addEventListener("resize", drawFlat);

async function check(file) {
  $("checked").textContent = `Checking ${file.name} ...`;
  try {
    const found = unpacked(await ask("verify", {text: await file.text()}));
    const rows = (found.findings || []).map(one => element("tr", {}, element("td", {textContent: signed(one.claim)}), element("td", {className: one.status, textContent: one.status}), element("td", {textContent: signed(one.reason)})));
    $("checked").replaceChildren(element("p", {className: found.status || "refuted", textContent: found.error ? found.error : `${file.name}: ${found.status}`}), element("p", {className: "quiet", textContent: signed(found.about || "")}),
      element("div", {className: "scroll"}, element("table", {}, ...rows)));
  } catch (error) { $("checked").textContent = error.message; }
}
$("certificate").onchange = e => e.target.files.length && check(e.target.files[0]);
$("drop").ondragover = e => { e.preventDefault(); $("drop").classList.add("over"); };
$("drop").ondragleave = () => $("drop").classList.remove("over");
$("drop").ondrop = e => { e.preventDefault(); $("drop").classList.remove("over"); if (e.dataTransfer.files.length) check(e.dataTransfer.files[0]); };

build(); restore(); send(false);
