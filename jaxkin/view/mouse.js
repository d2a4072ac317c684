"use strict";
// Mouse and touch in the picture of `viewer.js`: they turn, shift and magnify it, and click on parts.
const STILL = 4;  // pixels that a pointer may move between down and up in a click: hands are not still

function listenToCanvas(clicked = null) {  // `clicked` is called with the index of the part that was clicked on, or -1
  const canvas = $("canvas"), fingers = new Map();
  let travel = 0;
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    travel = fingers.size > 1 ? Infinity : 0;
  });
  canvas.addEventListener("pointermove", event => {
    const old = fingers.get(event.pointerId), others = [...fingers].filter(([id]) => id !== event.pointerId);
    if (!old) return;
    const dx = event.clientX - old[0], dy = event.clientY - old[1], many = others.length;
    travel += Math.hypot(dx, dy);
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
  canvas.addEventListener("pointerup", event => {
    const box = canvas.getBoundingClientRect();
    if (clicked && travel <= STILL && event.button === 0) clicked(partAt(event.clientX - box.left, event.clientY - box.top));
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, event => fingers.delete(event.pointerId));
  canvas.addEventListener("contextmenu", event => event.preventDefault());
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    zoom = Math.min(CLOSEST, Math.max(0.2, zoom * Math.exp(-0.0012 * event.deltaY)));
    redraw();
  }, { passive: false });
  new ResizeObserver(redraw).observe(canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}
