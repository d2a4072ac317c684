"use strict";
// The controls of the animated page: slider, play, legend, mouse and touch. Drawing is in `viewer.js`.
const DURATION = 6000;  // milliseconds from one end of the range to the other

function show(newPose) {
  pose = newPose;
  $("slider").value = pose;
  $("value").textContent = motion.labels[pose];
  const said = motion.problems[pose] || motion.lost[pose];
  $("problem").hidden = said === "";
  $("problem").textContent = said;
  $("problem").className = motion.problems[pose] ? "card" : "card lost";
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
  if (motion.cyclic) place %= end;
  else if (place >= end || place <= 0) [place, direction] = place <= 0 ? [0, 1] : [end, -1];
  show(closed[Math.round(place)]);
  requestAnimationFrame(step);
}

function lookFrom(newYaw, newPitch) {
  [yaw, pitch, zoom, shift] = [newYaw, newPitch, 1, [0, 0]];
  redraw();
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
  row("paths of points", null, on => { showPaths = on; });
}

function listen() {
  const canvas = $("canvas"), fingers = new Map();
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener("pointermove", event => {
    const old = fingers.get(event.pointerId), others = [...fingers].filter(([id]) => id !== event.pointerId);
    if (!old) return;
    const dx = event.clientX - old[0], dy = event.clientY - old[1], many = others.length;
    if (many || event.shiftKey || event.buttons > 1) {
      const pixels = 2 * FIELD / canvas.clientHeight / (many + 1);
      shift = [shift[0] + dx * pixels, shift[1] - dy * pixels];
    } else [yaw, pitch] = [yaw + 0.008 * dx, Math.min(1.57, Math.max(-1.57, pitch + 0.008 * dy))];
    if (many) {
      const gap = ([x, y]) => Math.hypot(x - others[0][1][0], y - others[0][1][1]);
      zoom *= gap([event.clientX, event.clientY]) / Math.max(gap(old), 1);
    }
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    redraw();
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, event => fingers.delete(event.pointerId));
  canvas.addEventListener("contextmenu", event => event.preventDefault());
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    zoom = Math.min(30, Math.max(0.2, zoom * Math.exp(-0.0012 * event.deltaY)));
    redraw();
  }, { passive: false });
  $("slider").addEventListener("input", () => { play(false); show(Number($("slider").value)); });
  $("play").addEventListener("click", () => play(!playing));
  $("reset").addEventListener("click", () => lookFrom(motion.yaw, motion.pitch));
  $("face").addEventListener("click", () => lookFrom(0, 0));
  addEventListener("keydown", event => {
    if (event.key !== " " || event.target.tagName === "BUTTON") return;
    event.preventDefault();
    play(!playing);
  });
  new ResizeObserver(redraw).observe(canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

function start() {
  $("title").textContent = document.title = motion.title;
  $("subtitle").textContent = motion.subtitle;
  const last = motion.labels.length - 1, stop = i => `${Math.min(100, Math.max(0, 100 * i / Math.max(last, 1)))}%`;
  $("slider").max = last;
  $("value").style.minWidth = `${Math.min(24, Math.max(...motion.labels.map(label => label.length)))}ch`;
  $("play").disabled = closed.length < 2;
  $("face").hidden = !motion.planar;
  $("slider").style.background = `linear-gradient(to right, ${motion.problems.map((problem, i) =>
    `var(${problem ? "--failed" : motion.lost[i] ? "--lost" : "--line"}) ${stop(i - 0.5)} ${stop(i + 0.5)}`)})`;
  if (!gl) {
    $("problem").hidden = false;
    $("problem").textContent = "This browser does not offer WebGL 2, which the animation is drawn with.";
    return;
  }
  prepare();
  legend();
  listen();
  lookFrom(motion.yaw, motion.pitch);
  show(pose);
  play(!matchMedia("(prefers-reduced-motion: reduce)").matches);
}

start();
