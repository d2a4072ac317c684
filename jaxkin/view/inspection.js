"use strict";
// The lists of the inspection: what is chosen in them or in the picture shows, all else fades. Drawing is in `viewer.js`.
const GHOST = 0.06, BESIDE = 0.22;  // how much is seen of what is not chosen, and of the rest of the bodies of what is
const MANY = 40;  // rows of a list that is open at first: a screen
const SMALL = 0.12;  // radius over that of the picture below which a choice is brought near
const movable = [...scene.joints.keys()].filter(i => scene.joints[i].coordinates.length);  // the joints with an axis
let clicked = false;  // whether the choice was made in the picture, where it is seen already
const rows = new Map();  // "kind=name" -> the rows of the lists that choose it

const ENTRIES = {  // what can be chosen: its name, its parts, and the joints whose axes are shown
  body: scene.bodies.map((body, i) => ({ ...body, key: body.name, parts: body.parts, joints: [] })),
  joint: scene.joints.map((joint, i) => ({ ...joint, key: joint.name, joints: [i] })),
  note: scene.notes.map((note, i) => ({
    ...note, key: String(i + 1), joints: scene.joints.flatMap((joint, j) => joint.name === note.joint ? [j] : []),
  })),
  part: scene.parts.map((part, i) => ({
    ...part, key: part.name, parts: [i], joints: scene.joints.flatMap((joint, j) => joint.parts.includes(i) ? [j] : []),
  })),
};

function make(tag, text = "", kind = "") {
  const element = document.createElement(tag);
  element.textContent = text;
  element.className = kind;
  return element;
}

function link(kind, index, title, small) {
  const row = make("button", "", "row"), entry = ENTRIES[kind][index], key = `${kind}=${entry.key}`;
  if (entry.color) row.append(make("i"));
  if (entry.color) row.lastChild.style.background = `rgb(${entry.color.map(c => Math.round(255 * c))})`;
  row.append(title);
  if (entry.inferred && kind === "joint") row.append(make("span", "inferred", "tag"));
  if (small) row.append(make("small", small));
  row.addEventListener("click", () => { location.hash = `${kind}=${encodeURIComponent(entry.key)}`; });
  rows.set(key, [...rows.get(key) ?? [], row]);
  return row;
}

const bodyOf = index => scene.bodies[scene.parts[index].body];
const fixedness = body => body.fixed ? `${body.name} (fixed)` : body.name;

const TITLES = {  // a row of each kind: what it is called, and a line in small letters
  body: body => [fixedness(body), body.parts.length > 1 ? `${body.parts.length} parts` : ""],
  joint: joint => [joint.name, `${joint.kind}${joint.evidence ? ` · ${joint.evidence}` : ""}`],
  note: note => [note.text, ""],
  part: part => [part.name, part.path.join(" / ")],
};
const row = (kind, index) => link(kind, index, ...TITLES[kind](ENTRIES[kind][index]));

function section(title, kind, indices, open) {
  if (!indices.length) return;
  const box = make("details");
  box.open = open;
  box.append(make("summary", `${title} (${indices.length})`), ...indices.map(index => row(kind, index)));
  $("lists").append(box);
}

function lists() {
  const every = kind => [...ENTRIES[kind].keys()];
  section("Joints", "joint", movable, true);
  const groups = [...new Set(scene.notes.map(note => note.group))].sort();  // "Contacts", "Inferred ...", "Nearly ...", "Noted"
  for (const group of groups)
    section(group, "note", every("note").filter(i => scene.notes[i].group === group), scene.notes.length < MANY);
  section("Bodies", "body", every("body"), scene.bodies.length < MANY && scene.joints.length > 0);
  section("Joints without freedoms", "joint", every("joint").filter(i => !movable.includes(i)), false);
  section("Parts", "part", every("part"), scene.joints.length === 0);
}

function facts(kind, entry) {  // what the card says of a choice: headings, each with texts or rows
  if (kind === "body") return [["Parts", entry.parts.map(i => row("part", i))]];
  if (kind === "note") return [[entry.group, [entry.text]], ["Joints", entry.joints.map(j => row("joint", j))], ["Parts", entry.parts.map(i => row("part", i))]];
  if (kind === "joint") return [
    ["Kind", [entry.kind]], ["Coordinates, to drive", entry.coordinates],
    ["Known from", [entry.evidence]], ["Sizes", entry.sizes.map(([name, value]) => `${name}: ${value}`)],
    ["Contacts", entry.contacts], ["Parts", entry.parts.map(i => row("part", i))],
  ];
  const index = entry.parts[0];
  return [
    ["Name in the file", [entry.original]], ["Sub-assembly", [entry.path.join(" / ")]], ["Size", [entry.size]],
    ["Body", [row("body", scene.parts[index].body)]],
    ["Joints", entry.joints.filter(j => movable.includes(j)).map(j => row("joint", j))],
    ["Assumed of it", scene.notes.flatMap((note, n) => note.parts.includes(index) ? [row("note", n)] : [])],
    ["Faces that were not understood", entry.notes],
  ];
}

function card(kind, entry) {
  const copy = make("button", "Copy name"), title = kind === "body" ? fixedness(entry) : kind === "note" ? "Assumption" : entry.name;
  copy.addEventListener("click", () => navigator.clipboard?.writeText(entry.name));
  const near = make("button", "Look closer");
  near.addEventListener("click", () => approach(kind, entry, true));
  $("chosen").replaceChildren(make("h2", title), ...(kind === "part" || kind === "joint" ? [copy, " "] : []), ...(entry.parts.length ? [near] : []));
  for (const [heading, lines] of facts(kind, entry)) {
    const told = lines.filter(line => line !== "");
    if (told.length) $("chosen").append(make("h3", heading), ...told.map(line => typeof line === "string" ? make("p", line) : line));
  }
}

function extent(kind, entry) {  // middle and radius of what is to be seen: of a joint the axis, otherwise the smallest part
  const clouds = kind === "joint" && entry.joints.length && entry.coordinates.length
    ? [paths[movable.indexOf(entry.joints[0])].points] : entry.parts.map(i => decode(scene.parts[i].points, Float32Array));
  const found = clouds.filter(points => points.length).map(points => {
    const ends = [0, 1, 2].map(j => points.reduce(([low, high], x, i) => i % 3 === j ? [Math.min(low, x), Math.max(high, x)] : [low, high], [9, -9]));
    return [ends.map(([low, high]) => (low + high) / 2), Math.hypot(...ends.map(([low, high]) => high - low)) / 2];
  });
  return found.sort((one, other) => one[1] - other[1])[0];
}

function approach(kind, entry, always) {  // bring what is chosen near, if it is too small to be seen from where we are
  const [place, radius] = extent(kind, entry) ?? [[0, 0, 0], 1];
  if (always || radius * zoom < SMALL) lookAt(place, Math.max(2 * radius, 1e-3));
}

function address() {  // what the address names after "#": a kind and a name
  try {
    const [kind, ...rest] = decodeURIComponent(location.hash.slice(1)).split("=");
    return [kind, rest.join("=")];
  } catch {  // a lonely "%"
    return ["", ""];
  }
}

function choose() {
  const [kind, key] = address(), every = Object.hasOwn(ENTRIES, kind) ? ENTRIES[kind] : [];
  const entry = every.find(each => each.key === key) ?? every[Number(key) - 1];
  const shown = new Set(entry?.parts ?? []), around = new Set((entry?.parts ?? []).flatMap(i => bodyOf(i).parts));
  parts.forEach((part, i) => { part.alpha = !shown.size || shown.has(i) ? 1 : around.has(i) ? BESIDE : GHOST; });
  paths.forEach((path, i) => { path.shown = !!entry && entry.joints.includes(movable[i]); });
  if (entry) card(kind, entry);
  else $("chosen").replaceChildren(make("p", "Click on a part, or on a row of the lists."));
  for (const [name, found] of rows) for (const each of found) {
    const chosen = !!entry && name === `${kind}=${entry.key}`;
    each.classList.toggle("chosen", chosen);
    if (chosen && $("lists").contains(each)) each.closest("details").open ? each.scrollIntoView({ block: "nearest" }) : null;
  }
  if (entry && !clicked && entry.parts.length) approach(kind, entry, false);
  clicked = false;
  redraw();
}

function filter() {
  const words = $("filter").value.toLowerCase();
  for (const box of $("lists").children) {
    const all = [...box.querySelectorAll(".row")];
    for (const each of all) each.hidden = !each.textContent.toLowerCase().includes(words);
    box.hidden = all.every(each => each.hidden);
    if (words && !box.hidden) box.open = true;
  }
}

function start() {
  $("title").textContent = document.title = scene.title;
  $("subtitle").textContent = scene.subtitle;
  for (const text of scene.missing) $("missing").append(make("p", text));
  lists();
  $("filter").addEventListener("input", filter);
  $("clear").addEventListener("click", () => { location.hash = ""; });
  $("reset").addEventListener("click", () => lookFrom(scene.yaw, scene.pitch));
  if (!gl) {
    $("missing").append(make("p", "This browser does not offer WebGL 2, which the assembly is drawn with."));
    return;
  }
  prepare();
  listenToCanvas(index => {
    clicked = true;
    location.hash = index < 0 ? "" : `part=${encodeURIComponent(scene.parts[index].name)}`;
  });
  addEventListener("hashchange", choose);
  addEventListener("keydown", event => { if (event.key === "Escape") location.hash = ""; });
  lookFrom(scene.yaw, scene.pitch);
  choose();
}

start();
