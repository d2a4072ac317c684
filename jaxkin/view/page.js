"use strict";
// The controls of the animated page: slider, play, legend. Drawing is in `viewer.js`, mouse and touch are in `mouse.js`.
const DURATION = 6000;  // milliseconds from one end of the range to the other

function show(newPose) {
  pose = newPose;
  $("slider").value = pose;
  $("value").textContent = scene.labels[pose];
  const said = scene.problems[pose] || scene.lost[pose];
  $("problem").hidden = said === "";
  $("problem").textContent = said;
  $("problem").className = scene.problems[pose] ? "card" : "card lost";
  redraw();
}

let playing = false, place = 0, direction = 1, last = 0;  // `place` counts in closed poses: playing leaves out the others

function play(on) {
  playing = on && closed.length > 1;
  place = Math.max(0, closed.findIndex(other => other >= pose));
  last = performance.now();
  $("icon").setAttribute("d", playing ? "M2 1h3.5v12H2zM8.5 1H12v12H8.5z" : "M3 1l10 6-10 6z");
  if (playing) requestAnimationFrame(step);
}

function step(now) {
  if (!playing) return;
  const end = closed.length - 1;
  const passed = Math.min(Math.max(now - last, 0), 100);  // a frame may be timed a little before the click that asked for it
  place += direction * passed * end / DURATION;
  last = now;
  if (scene.cyclic) place %= end;
  else if (place >= end || place <= 0) [place, direction] = place <= 0 ? [0, 1] : [end, -1];
  show(closed[Math.round(place)]);
  requestAnimationFrame(step);
}

function legend() {
  const row = (name, color, act) => {
    const label = document.createElement("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = true;
    box.addEventListener("change", () => { act(box.checked); redraw(); });
    label.append(box);
    if (color) label.append(document.createElement("i"));
    if (color) label.lastChild.style.background = `rgb(${color.map(c => Math.round(255 * c))})`;
    label.append(name);
    $("legend").append(label);
  };
  for (const body of bodies) row(body.fixed ? `${body.name} (fixed)` : body.name, body.color, on => { body.shown = on; });
  if (!paths.length) return;
  $("legend").append(document.createElement("hr"));
  row("paths of points", null, on => { for (const path of paths) path.shown = on; });
}

function listen() {
  listenToCanvas();
  $("slider").addEventListener("input", () => { play(false); show(Number($("slider").value)); });
  $("play").addEventListener("click", () => play(!playing));
  $("reset").addEventListener("click", () => lookFrom(scene.yaw, scene.pitch));
  $("face").addEventListener("click", () => lookFrom(0, 0));
  addEventListener("keydown", event => {
    if (event.key !== " " || event.target.tagName === "BUTTON") return;
    event.preventDefault();
    play(!playing);
  });
}

function start() {
  $("title").textContent = document.title = scene.title;
  $("subtitle").textContent = scene.subtitle;
  const last = scene.labels.length - 1, stop = i => `${Math.min(100, Math.max(0, 100 * i / Math.max(last, 1)))}%`;
  $("slider").max = last;
  $("value").style.minWidth = `${Math.min(24, Math.max(...scene.labels.map(label => label.length)))}ch`;
  $("play").disabled = closed.length < 2;
  $("face").hidden = !scene.planar;
  $("slider").style.background = `linear-gradient(to right, ${scene.problems.map((problem, i) =>
    `var(${problem ? "--failed" : scene.lost[i] ? "--lost" : "--line"}) ${stop(i - 0.5)} ${stop(i + 0.5)}`)})`;
  if (!gl) {
    $("problem").hidden = false;
    $("problem").textContent = "This browser does not offer WebGL 2, which the animation is drawn with.";
    return;
  }
  prepare();
  legend();
  listen();
  lookFrom(scene.yaw, scene.pitch);
  show(pose);
  play(!matchMedia("(prefers-reduced-motion: reduce)").matches);
}

start();
