#!/usr/bin/env python3
"""Compares the page of each example with `opaline render`: web_pages.py PROGRAM FOLDER [BROWSER].

Bakes all examples that a page can show at draft quality into FOLDER (those that are there already are kept), exports a
page of each, takes a picture of it in a headless Chromium and prints how many pixels lie more than 2/255 from those of
`render`, under two lights, one of them turned. About eight minutes on two cores.
"""

import base64
import re
import subprocess
import sys
import zlib
from pathlib import Path

WIDTH, HEIGHT = 240, 180
VIEWS = [("sky:3,35", 50), ("studio", 0)]
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


def main(program, folder, browser="chromium"):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    run = lambda *arguments: subprocess.run([program, *map(str, arguments), "--quiet"], check=True, capture_output=True)
    listed = subprocess.run([program, "example", "--list"], capture_output=True, text=True).stdout
    names = re.findall(r"^  ([\w-]+)", listed.split("Lights")[0], re.MULTILINE)
    print("| example | light | pixels beyond 2/255 | largest difference | mean |\n|---|---|---:|---:|---:|")
    for name in names:
        asset, page = folder / f"{name}.opal", folder / f"page-{name}"
        if not asset.exists():
            run("example", name, "-o", folder / "scenes")
            scene = next(p for p in (folder / "scenes").glob(f"{name}.*") if p.suffix in (".gltf", ".json"))
            run("bake", scene, "-o", asset, "--quality", "draft")
        run("export-web", asset, "-o", page, *[w for light, _ in VIEWS for w in ("--light", light)])
        for light, turn in VIEWS:
            picture = folder / "render.png"
            run("render", asset, "--light", light, "--rotate-light", turn, "--size", f"{WIDTH}x{HEIGHT}", "-o", picture)
            expected = read_png(picture)
            shown = page_pixels(page, f"light={light}&rotate={turn}", browser, folder / "profile")
            if shown is None:
                print(f"| {name} | {light} | no picture | | |", flush=True)
                continue
            far = [max(abs(expected[3 * i + k] - shown[4 * i + k]) for k in range(3)) for i in range(WIDTH * HEIGHT)]
            print(f"| {name} | {light}, {turn}° | {100 * sum(d > 2 for d in far) / len(far):.2f} % | {max(far)} | "
                  f"{sum(far) / len(far):.3f} |", flush=True)


if __name__ == "__main__":
    if not 3 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
