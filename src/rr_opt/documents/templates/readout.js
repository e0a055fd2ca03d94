// The values under the pointer. A figure has them in the metadata of its SVG.
"use strict";
const number = (v) => String(Number(v.toPrecision(4)));
const parts = (label) => {
  const cut = label.lastIndexOf(", ");
  return cut < 0 ? [label, ""] : [label.slice(0, cut), " " + label.slice(cut + 2)];
};
const text = (scale, v, name) => {
  const [own, unit] = parts(scale.label);
  if (scale.words) {
    const [places, words] = scale.words;
    return words[places.reduce((best, one, k) =>
      Math.abs(one - v) < Math.abs(places[best] - v) ? k : best, 0)];
  }
  return `${name ?? own} ${number(v)}${unit}`.trim();
};
const value = (scale, share) => {
  const at = scale.at, k = Math.min(Math.floor(share * (at.length - 1)), at.length - 2);
  return at[k] + (at[k + 1] - at[k]) * (share * (at.length - 1) - k);
};
const share = (scale, v) => {
  const at = scale.at, up = at[at.length - 1] > at[0];
  let k = 0;
  while (k < at.length - 2 && (up ? at[k + 1] < v : at[k + 1] > v)) k++;
  return (k + (v - at[k]) / (at[k + 1] - at[k])) / (at.length - 1);
};
const nearest = (row, v) =>
  row.reduce((best, one, k) => Math.abs(one - v) < Math.abs(row[best] - v) ? k : best, 0);

function told(axes, sx, sy, width, height) {
  const x = value(axes.x, sx), y = value(axes.y, 1 - sy), said = [];
  if (axes.cells) {
    const c = axes.cells, z = c.z[nearest(c.y, y)][nearest(c.x, x)];
    said.push(text(axes.x, x), text(axes.y, y), z === null ? "–" : text({label: c.label}, z));
  }
  const rows = [];
  let close = null, least = 16;
  for (const line of axes.lines) {
    const n = line.x.length, runs = n > 2 && line.x.every((v, k) => !k || v >= line.x[k - 1]);
    if (runs && !axes.y.words) {
      if (x < line.x[0] || x > line.x[n - 1] || axes.cells) continue;
      const k = Math.max(1, line.x.findIndex((v) => v >= x)), a = line.x[k - 1], b = line.x[k];
      const v = line.y[k - 1] + (b > a ? (x - a) / (b - a) : 0) * (line.y[k] - line.y[k - 1]);
      rows.push(text(axes.y, v, line.label || undefined));
    } else {
      for (let k = 0; k < n; k++) {
        const off = Math.hypot((share(axes.x, line.x[k]) - sx) * width,
          (1 - share(axes.y, line.y[k]) - sy) * height);
        if (off < least) { least = off; close = [line, k]; }
      }
    }
  }
  for (const band of axes.bands) {
    const cut = [];
    band.points.forEach(([bx, by], k) => {
      const [ax, ay] = band.points[k ? k - 1 : band.points.length - 1];
      if ((ax <= x) !== (bx <= x)) cut.push(ay + (x - ax) / (bx - ax) * (by - ay));
    });
    const unit = parts(axes.y.label)[1];
    if (cut.length > 1)
      rows.push(`${band.label} ${number(Math.min(...cut))} to ${number(Math.max(...cut))}${unit}`);
  }
  if (close) {
    const [line, k] = close;
    said.push(line.label, text(axes.x, line.x[k]), text(axes.y, line.y[k]));
  } else if (rows.length) said.push(text(axes.x, x), ...rows);
  return said.filter(Boolean);
}

for (const img of document.querySelectorAll("figure img")) {
  let all = null;
  const box = document.createElement("output");
  box.className = "readout";
  box.hidden = true;
  img.after(box);
  const look = (event) => {
    if (all === null) {
      const found = /<metadata id="readout">([^]*?)<\/metadata>/.exec(decodeURIComponent(img.src));
      const plain = document.createElement("textarea");
      plain.innerHTML = found ? found[1] : "[]";
      all = JSON.parse(plain.value);
    }
    const seen = img.getBoundingClientRect();
    const px = (event.clientX - seen.left) / seen.width, py = (event.clientY - seen.top) / seen.height;
    box.hidden = true;
    for (const axes of all) {
      const [left, top, right, bottom] = axes.box;
      if (px < left || px > right || py < top || py > bottom) continue;
      const said = told(axes, (px - left) / (right - left), (py - top) / (bottom - top),
        (right - left) * seen.width, (bottom - top) * seen.height);
      if (!said.length) continue;
      box.replaceChildren(...said.flatMap((one, k) => k ? [document.createElement("br"), one] : [one]));
      box.hidden = false;
      const room = img.parentElement.getBoundingClientRect();
      const over = px > 0.55 ? -box.offsetWidth - 14 : 14;
      box.style.left = `${event.clientX - room.left + over}px`;
      box.style.top = `${event.clientY - room.top - box.offsetHeight / 2}px`;
    }
  };
  img.addEventListener("pointermove", look);
  img.addEventListener("pointerdown", look);
  img.addEventListener("pointerleave", () => { box.hidden = true; });
}
