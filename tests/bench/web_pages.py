#!/usr/bin/env python3
"""Compares the page of each example with `opaline render --backend cpu`: web_pages.py PROGRAM FOLDER [BROWSER].

Bakes all examples that a page can show at draft quality into FOLDER (those that are there already are kept), exports a
page of each, takes a picture of it in a headless Chromium and prints how many pixels lie more than 2/255 from those of
`render`, under two lights, one of them turned. Writes these and their differences, eight times as large, as PNGs.

A graphics driver snaps vertices to a grid, Chromium's software driver to 1/16 sample, which moves samples beside edges
across. So pixels at edges count apart: those that `render` itself shows differently, by more than 1/255, when its camera
turns by one step of that grid to any side. They may lie within 2/255 of the range of these pictures.
"""

import base64
import math
import re
import struct
import subprocess
import sys
import zlib
from pathlib import Path

WIDTH, HEIGHT = 240, 180
VIEWS = [("sky:3,35", 50), ("studio", 0)]
FIELD = 32  # of view, upward [degrees]
SNAP = 1 / (3 * 16)  # [pixels], at three samples a side of a pixel
FLAGS = ["--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
         "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--force-device-scale-factor=0.2", "--virtual-time-budget=200000", "--dump-dom"]
PROBE = """<script>opaline.page.ready.then(() => opaline.page.takePicture(%d, %d)).then(({ pixels }) => {
  let text = "";
  for (const byte of pixels) text += String.fromCharCode(byte);
  const pre = document.createElement("pre");
  pre.id = "pixels";
  pre.textContent = btoa(text);
  document.body.append(pre);
});</script>""" % (WIDTH, HEIGHT)


def read_png(path):
    """Bytes of an 8-bit PNG without alpha, three a pixel, row after row."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        packed += data[at + 8:at + 8 + size] if kind == b"IDAT" else b""
        at += 12 + size
    raw, stride, pixels, above = zlib.decompress(packed), 3 * WIDTH, bytearray(), bytearray(3 * WIDTH)
    for y in range(HEIGHT):
        line, mode = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)]), raw[y * (stride + 1)]
        for x in range(stride):
            a, b, c = (line[x - 3] if x > 2 else 0), above[x], (above[x - 3] if x > 2 else 0)
            nearest = min((a, b, c), key=lambda v: abs(a + b - c - v))
            line[x] = line[x] + (0, a, b, (a + b) // 2, nearest)[mode] & 255
        pixels += line
        above = line
    return pixels


def page_pixels(page, address, browser, profile):
    index = page / "index.html"
    (page / "probe.html").write_text("<script>requestAnimationFrame = () => 0</script>" + index.read_text() + PROBE)
    url = f"{(page / 'probe.html').absolute().as_uri()}#{address}"
    dom = subprocess.run([browser, *FLAGS, f"--user-data-dir={profile}", url], capture_output=True, text=True).stdout
    (page / "probe.html").unlink()
    found = re.search(r'<pre id="pixels">([^<]*)<', dom)
    return base64.b64decode(found[1]) if found else None


def write_png(path, pixels):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes(pixels[3 * WIDTH * y:3 * WIDTH * (y + 1)]) for y in range(HEIGHT))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def shifted_views(page):
    """Options of `render` for the page's first view, and for eight that move the picture by SNAP."""
    found = re.search(r'put\("asset","camera","f32","([^"]*)"', (page / "asset-data.js").read_text())
    values = struct.unpack("<6f", base64.b64decode(found[1])[:24])
    eye, target = values[:3], values[3:]
    away = [e - t for e, t in zip(eye, target)]
    distance = math.hypot(*away)
    level = math.hypot(away[0], away[2])
    right = [away[2] / level, 0, -away[0] / level]
    back = [a / distance for a in away]
    up = [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2],
          back[0] * right[1] - back[1] * right[0]]
    step = SNAP * distance * 2 * math.tan(math.radians(FIELD / 2)) / HEIGHT
    text = lambda point: ",".join(repr(x) for x in point)
    for x, y in [(0, 0), (-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (-1, 1), (1, -1), (1, 1)]:
        aim = [t + step * (x * r + y * u) for t, r, u in zip(target, right, up)]
        yield ["--eye", text(eye), "--target", text(aim)]


def differences_of(expected, shown):
    """The largest of three bands, of each pixel."""
    return [max(abs(expected[3 * i + k] - shown[4 * i + k]) for k in range(3)) for i in range(WIDTH * HEIGHT)]


def count_beyond(differences, pictures, shown):
    """Pixels beyond 2/255: elsewhere than at edges, at edges, of these beyond the range."""
    away, at_edges, beyond = 0, 0, 0
    for i, difference in enumerate(differences):
        if difference <= 2:
            continue
        page, bands = shown[4 * i:4 * i + 3], range(3 * i, 3 * i + 3)
        ranges = [(min(p[k] for p in pictures), max(p[k] for p in pictures)) for k in bands]
        if all(high - low <= 1 for low, high in ranges):
            away += 1
            continue
        at_edges += 1
        beyond += any(not low - 2 <= value <= high + 2 for value, (low, high) in zip(page, ranges))
    return away, at_edges, beyond


def main(program, folder, browser="chromium"):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    run = lambda *arguments: subprocess.run([program, *map(str, arguments), "--quiet"], check=True, capture_output=True)
    listed = subprocess.run([program, "example", "--list"], capture_output=True, text=True).stdout
    names = re.findall(r"^  ([\w-]+)", listed.split("Lights")[0], re.MULTILINE)
    share = lambda pixels: f"{100 * pixels / (WIDTH * HEIGHT):.3f} %"
    print("| example | light | beyond 2/255 away from edges | at edges | of these beyond the range | largest | mean |\n"
          "|---|---|---:|---:|---:|---:|---:|")
    for name in names:
        asset, page = folder / f"{name}.opal", folder / f"page-{name}"
        if not asset.exists():
            run("example", name, "-o", folder / "scenes")
            scene = next(p for p in (folder / "scenes").glob(f"{name}.*") if p.suffix in (".gltf", ".json"))
            run("bake", scene, "-o", asset, "--quality", "draft")
        run("export-web", asset, "-o", page, *[w for light, _ in VIEWS for w in ("--light", light)])
        for light, turn in VIEWS:
            def render(view):
                run("render", asset, "--light", light, "--rotate-light", turn, "--size", f"{WIDTH}x{HEIGHT}", *view,
                    "--backend", "cpu", "-o", folder / "render.png")
                return read_png(folder / "render.png")
            expected = render([])
            shown = page_pixels(page, f"light={light}&rotate={turn}", browser, folder / "profile")
            if shown is None:
                print(f"| {name} | {light} | no picture | | | | |", flush=True)
                continue
            differences = differences_of(expected, shown)
            shifted = [render(view) for view in shifted_views(page)] if max(differences) > 2 else []
            away, at_edges, beyond = count_beyond(differences, shifted, shown)
            stem = f"{name}-{light.split(':')[0]}"
            write_png(folder / f"{stem}-render.png", expected)
            write_png(folder / f"{stem}-page.png", [value for i in range(WIDTH * HEIGHT) for value in shown[4 * i:4 * i + 3]])
            write_png(folder / f"{stem}-difference.png", [min(255, 8 * d) for d in differences for _ in range(3)])
            print(f"| {name} | {light}, {turn}° | {share(away)} | {share(at_edges)} | {share(beyond)} | {max(differences)} | "
                  f"{sum(differences) / len(differences):.3f} |", flush=True)


if __name__ == "__main__":
    if not 3 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
