"use strict";
// Copy buttons, zoom, values of curves and moving pictures of a page; it reads nothing but the page.
const still = matchMedia("(prefers-reduced-motion: reduce)").matches;

function button(text, name, act) {
  const made = document.createElement("button");
  made.type = "button"; made.className = name; made.textContent = text;
  made.addEventListener("click", () => act(made));
  return made;
}

function plain(cell) {
  return cell.innerText.replace(/[\u202f\u00a0]/g, "").replace(/\u2212/g, "-").replace(/\s+/g, " ").trim();
}

function copied(text) {
  if (navigator.clipboard && isSecureContext) return navigator.clipboard.writeText(text);
  const area = document.createElement("textarea");
  area.value = text; document.body.append(area); area.select();
  const done = document.execCommand("copy"); area.remove();
  return done ? Promise.resolve() : Promise.reject();
}

for (const table of document.querySelectorAll("table:not(.entries)")) {
  const copy = button("Copy table", "copy", (own) => {
    const rows = [...table.rows].map((row) => [...row.cells].map(plain).join("\t"));
    copied(rows.join("\n")).then(() => { own.textContent = "Copied"; }, () => { own.textContent = "Not copied"; })
      .then(() => setTimeout(() => { own.textContent = "Copy table"; }, 1500));
  });
  table.after(copy);
}

for (const figure of document.querySelectorAll("figure.zoom")) {
  figure.after(button("Zoom in", "copy", (own) => {
    own.textContent = figure.classList.toggle("near") ? "Fit to the page" : "Zoom in";
  }));
}

const NEAREST = 16;

function along(axis, value) {
  const size = axis.log ? Math.log : Number, [low, high] = axis.limits.map(size), [from, to] = axis.ends;
  return from + (to - from) * (size(value) - low) / (high - low);
}

function placed(panels) {
  return panels.flatMap(({ x, y, curves }) => curves.flatMap(({ name, x: across, y: up }) => across.map((value, i) => ({
    left: along(x, value), top: along(y, up[i]),
    text: name + "\n" + (x.label || "x") + ": " + value.toPrecision(4) + "\n" + (y.label || "y") + ": " + up[i].toPrecision(4),
  }))));
}

for (const svg of document.querySelectorAll("svg[data-curves]")) {
  const points = placed(JSON.parse(svg.dataset.curves)), told = document.createElement("div");
  const mark = document.createElementNS(svg.namespaceURI, "circle"), title = svg.querySelector("title");
  svg.setAttribute("aria-label", title.textContent); title.remove();
  told.className = "told"; told.hidden = true; mark.setAttribute("class", "mark"); mark.setAttribute("r", 0);
  document.body.append(told); svg.append(mark);
  const leave = () => { told.hidden = true; mark.setAttribute("r", 0); };
  svg.addEventListener("pointerleave", leave);
  svg.addEventListener("pointermove", (event) => {
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    let best = null, least = NEAREST;
    for (const point of points) {
      const away = Math.hypot(point.left - at.x, point.top - at.y);
      if (away < least) { best = point; least = away; }
    }
    if (!best) return leave();
    told.textContent = best.text; told.hidden = false;
    told.style.left = Math.min(event.pageX + 14, scrollX + document.documentElement.clientWidth - told.offsetWidth - 4) + "px";
    told.style.top = event.pageY + 14 + "px";
    mark.setAttribute("cx", best.left); mark.setAttribute("cy", best.top); mark.setAttribute("r", 3.5);
  });
}

const pairs = (text) => text.split(" ").map((pair) => pair.split(",").map(Number));

function place(element, points) {
  if (element.tagName === "circle") {
    element.setAttribute("cx", points[0][0].toFixed(1)); element.setAttribute("cy", points[0][1].toFixed(1));
  } else {
    element.setAttribute("points", points.map((point) => point[0].toFixed(1) + "," + point[1].toFixed(1)).join(" "));
  }
}

function movers(svg) {
  return [...svg.querySelectorAll("[data-rest]")].map((element) => ({
    element, rest: pairs(element.dataset.rest),
    move: element.dataset.move ? pairs(element.dataset.move) : null,
    rows: element.dataset.rows ? JSON.parse(element.dataset.rows) : null,
  }));
}

function scene(svg) {
  const parts = movers(svg), frames = svg.dataset.frames ? JSON.parse(svg.dataset.frames) : null, hump = svg.querySelector("[data-speed]");
  const fps = Number(svg.dataset.drive), last = frames ? frames.length - 1 : 0;
  return {
    svg, seconds: frames ? last / fps : 0,
    show(time) {
      if (!frames) {
        const share = Math.sin(2 * Math.PI * 0.6 * time + Math.PI / 2);
        for (const { element, rest, move } of parts) place(element, rest.map((p, i) => [p[0] + share * move[i][0], p[1] + share * move[i][1]]));
        return;
      }
      const number = Math.min(last, Math.max(0, Math.round(time * fps))), q = frames[number];
      for (const { element, rest, rows } of parts) {
        place(element, rest.map((p, i) => rows[i].reduce((sum, [j, dx, dy]) => [sum[0] + dx * q[j], sum[1] + dy * q[j]], p)));
      }
      hump.setAttribute("transform", "translate(" + (-Number(hump.dataset.speed) * number).toFixed(1) + ",0)");
    },
  };
}

for (const box of document.querySelectorAll(".animated")) {
  const scenes = [...box.querySelectorAll("svg.moving")].map(scene), seen = new Set();
  if (!scenes.length) continue;
  const watch = new IntersectionObserver((entries) => {
    for (const entry of entries) seen[entry.isIntersecting ? "add" : "delete"](entry.target);
  });
  let playing = false, time = 0, before = 0, slider = null;
  const seconds = scenes[0].seconds;
  const draw = () => { for (const item of scenes) if (seen.has(item.svg)) item.show(time); if (slider) slider.value = time; };
  const step = (now) => {
    if (!playing) return;
    time += Math.min(0.1, (now - before) / 1000); before = now;
    if (seconds && time > seconds) time = 0;
    draw(); requestAnimationFrame(step);
  };
  const play = (own) => {
    playing = !playing; own.textContent = playing ? "Pause" : "Play"; before = performance.now();
    if (playing) requestAnimationFrame(step);
  };
  const control = button("Play", "copy", play);
  box.before(control);
  if (seconds) {
    slider = document.createElement("input");
    slider.type = "range"; slider.min = 0; slider.max = seconds; slider.step = "any"; slider.value = 0; slider.setAttribute("aria-label", "time of the drive");
    slider.addEventListener("input", () => { time = Number(slider.value); draw(); });
    control.after(slider);
  }
  for (const item of scenes) watch.observe(item.svg);
  if (!still) play(control);
  addEventListener("beforeprint", () => { for (const item of scenes) item.show(0); });
}
