#!/usr/bin/env python3
"""luxel beside Mitsuba 3: the same scenes, one thread, in turns, at a ladder of sample counts.

usage: python3 benches/peers/render.py [--scenes spheres,glass,mesh,terrain] [--mesh FILE.obj]
           [--spp 4,16,64,256] [--seeds 8] [--reference-spp 16384] [--out target/peers]

Needs Python 3.9 with venv, a network the first time, an LLVM that Mitsuba finds (DRJIT_LIBLLVM_PATH names another), and
`cargo build --release`. Makes an environment of its own under OUT with Mitsuba and OpenEXR in it, and writes there
  SCENE.ron, *.obj     what luxel renders; Mitsuba gets the same numbers
  rows.json            one row per render: seconds of processor time, relMSE; after every scene
  table.md, plot.svg   what the README shows

Seconds are processor time: of luxel the whole process, start, load and build included; of Mitsuba the call of `render`
after one that compiled its kernels (load, which builds its tree, stands by itself). relMSE = mean((x - r)^2 / (r^2 + 0.01))
over the pixels where the reference is at most 2 and nothing within 3 pixels is above 8: the lamp would rule it otherwise.
The reference is luxel's and Mitsuba's mean, half of the samples each, and its own variance is subtracted, as the two
halves tell it.
"""
import argparse, json, math, os, resource, subprocess, sys, time, venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SIZE, BOUNCES = 256, 7


def room(*more):
    """Six huge spheres as walls, a spherical lamp, and what stands in the room."""
    def wall(c, r, rgb):
        return {"center": c, "radius": r, "material": ("diffuse", rgb)}
    grey, red, blue = (0.75, 0.75, 0.75), (0.75, 0.25, 0.25), (0.25, 0.25, 0.75)
    walls = [wall((-1000, 0, 0), 940, red), wall((1000, 0, 0), 940, blue), wall((0, -1000, 0), 940, grey),
             wall((0, 1000, 0), 940, grey), wall((0, 0, -1000), 940, grey), wall((0, 0, 1000), 900, grey)]
    return {"at": (0, 0, 95), "look_at": (0, 0, 0), "vfov": 70, "sky": None, "meshes": [],
            "lamp": {"center": (0, 40, 0), "radius": 8, "radiance": 30}, "spheres": walls + list(more)}


def ball(c, r, *material):
    return {"center": c, "radius": r, "material": material}


def scenes(out, mesh):
    white = (0.8, 0.8, 0.8)
    spheres = room(ball((-36, -38, -20), 22, "diffuse", white), ball((36, -38, -20), 22, "diffuse", white),
                   ball((0, -42, 20), 18, "diffuse", white))
    glass = room(ball((-36, -38, -20), 22, "mirror", (0.95,) * 3), ball((0, -42, 20), 18, "glass", 1.5),
                 ball((36, -38, -20), 22, "glass", 1.5), ball((36, -38, -20), 19.8, "glass", 1 / 1.5))
    meshed = room()
    meshed["meshes"] = [{"file": mesh or bumpy(out / "bumpy.obj"), "material": ("diffuse", white)}]
    terrain = {"at": (0, 6, 14), "look_at": (0, 0, 0), "vfov": 40, "sky": 1.0, "lamp": None, "spheres": [],
               "meshes": [{"file": hills(out / "hills.obj"), "material": ("diffuse", white)}]}
    return {"spheres": spheres, "glass": glass, "mesh": meshed, "terrain": terrain}


def write_grid(path, columns, rows, point, wrap):
    """A grid of quads, two triangles each, normals from central differences."""
    if path.exists():
        return path
    width = columns if wrap else columns + 1
    places = [[point(i / columns, j / rows) for i in range(width)] for j in range(rows + 1)]
    sub = lambda a, b: [x - y for x, y in zip(a, b)]
    with open(path.with_suffix(".part"), "w") as f:
        for row in places:
            f.writelines("v %.6f %.6f %.6f\n" % p for p in row)
        for j in range(rows + 1):
            for i in range(width):
                last = width - 1
                east = places[j][(i + 1) % width if wrap else min(i + 1, last)]
                west = places[j][i - 1 if wrap or i else 0]
                a, b = sub(east, west), sub(places[min(j + 1, rows)][i], places[max(j - 1, 0)][i])
                n = (b[1] * a[2] - b[2] * a[1], b[2] * a[0] - b[0] * a[2], b[0] * a[1] - b[1] * a[0])
                s = 1 / (math.hypot(*n) or 1)
                f.write("vn %.6f %.6f %.6f\n" % (n[0] * s, n[1] * s, n[2] * s))
        for j in range(rows):
            for i in range(columns):
                k, e = j * width + i + 1, j * width + (i + 1) % width + 1
                f.write(f"f {k}//{k} {k + width}//{k + width} {e + width}//{e + width}\n")
                f.write(f"f {k}//{k} {e + width}//{e + width} {e}//{e}\n")
    path.with_suffix(".part").rename(path)
    return path


def bumpy(path):
    """A ball with bumps on the floor of the room: 69,696 triangles."""
    def point(u, v):
        v = 0.001 + 0.998 * v
        r = 28 + 2.5 * math.sin(14 * math.pi * u) * math.sin(9 * math.pi * v)
        s = r * math.sin(math.pi * v)
        return s * math.cos(2 * math.pi * u), r * math.cos(math.pi * v) - 32, -s * math.sin(2 * math.pi * u) - 10
    return write_grid(path, 264, 132, point, True)


def hills(path):
    """Hills under a sky: 1,003,520 triangles."""
    def point(u, v):
        x, z = 16 * u - 8, 16 * v - 8
        y = sum(math.sin(f * x + f) * math.cos(f * z * 1.3) / f for f in (1, 2.3, 5.1, 11.7, 27.1)) * 0.7
        return x, y, z
    return write_grid(path, 784, 640, point, False)


def ron(scene):
    """The scene as luxel reads it."""
    v = lambda p: "(%r, %r, %r)" % tuple(float(x) for x in p)
    def material(kind, value):
        return {"diffuse": lambda: f"Diffuse(color: Linear{v(value)})", "mirror": lambda: f"Mirror(color: Linear{v(value)})",
                "glass": lambda: f"Glass(ior: {value!r})"}[kind]()
    things = [f'(shape: Sphere(radius: {float(s["radius"])!r}), transform: (translate: {v(s["center"])}), material: "s{i}")'
              for i, s in enumerate(scene["spheres"])]
    things += [f'(shape: Mesh("{m["file"].name}"), material: "m{i}", normals: File)' for i, m in enumerate(scene["meshes"])]
    if scene["lamp"]:
        lamp = scene["lamp"]
        things.append(f'(shape: Sphere(radius: {float(lamp["radius"])!r}), transform: (translate: {v(lamp["center"])}), '
                      f'emissive: (radiance: {v((lamp["radiance"],) * 3)}))')
    materials = [f'"s{i}": {material(*s["material"])}' for i, s in enumerate(scene["spheres"])]
    materials += [f'"m{i}": {material(*m["material"])}' for i, m in enumerate(scene["meshes"])]
    return (f'Scene(version: 1, camera: (at: {v(scene["at"])}, look_at: {v(scene["look_at"])}, vfov_deg: {scene["vfov"]}),\n'
            f'  render: (size: ({SIZE}, {SIZE}), max_bounces: {BOUNCES}, filter: Box),\n'
            f'  background: Linear{v((scene["sky"] or 0,) * 3)},\n  materials: {{ {", ".join(materials)} }},\n'
            f'  entities: [\n    ' + ",\n    ".join(things) + "])\n")


class Luxel:
    name = "luxel"

    def __init__(self, out, name, scene):
        self.program = ROOT / "target" / "release" / "luxel"
        self.scene, self.image = out / f"{name}.ron", out / "luxel.exr"
        self.scene.write_text(ron(scene))
        self.load = 0.0

    def render(self, spp, seed):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([self.program, "render", self.scene, "--threads", "1", "--spp", str(spp), "--seed", str(seed),
                        "-o", self.image], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        import numpy as np, OpenEXR
        with OpenEXR.File(str(self.image), separate_channels=True) as file:
            return seconds, np.stack([file.channels()[c].pixels for c in "RGB"], 2).astype(float)


class Mitsuba:
    name = "Mitsuba"

    def __init__(self, out, name, scene):
        import mitsuba as mi
        rgb = lambda c: {"type": "rgb", "value": [float(x) for x in c]}
        def bsdf(kind, value):
            return {"diffuse": lambda: {"type": "twosided", "b": {"type": "diffuse", "reflectance": rgb(value)}},
                    "mirror": lambda: {"type": "conductor", "material": "none", "specular_reflectance": rgb(value)},
                    "glass": lambda: {"type": "dielectric", "int_ior": value, "ext_ior": 1.0}}[kind]()
        look = mi.ScalarTransform4f().look_at(origin=scene["at"], target=scene["look_at"], up=(0, 1, 0))
        film = {"type": "hdrfilm", "width": SIZE, "height": SIZE, "pixel_format": "rgb", "component_format": "float32",
                "rfilter": {"type": "box"}}
        d = {"type": "scene", "integrator": {"type": "path", "max_depth": BOUNCES + 1},
             "sensor": {"type": "perspective", "fov": scene["vfov"], "fov_axis": "y", "near_clip": 1e-2, "far_clip": 1e5,
                        "to_world": look, "film": film, "sampler": {"type": "independent", "sample_count": 4}}}
        for i, s in enumerate(scene["spheres"]):
            d[f"s{i}"] = {"type": "sphere", "center": s["center"], "radius": s["radius"], "bsdf": bsdf(*s["material"])}
        for i, m in enumerate(scene["meshes"]):
            d[f"m{i}"] = {"type": "obj", "filename": str(m["file"]), "bsdf": bsdf(*m["material"])}
        if scene["lamp"]:
            lamp = scene["lamp"]
            d["lamp"] = {"type": "sphere", "center": lamp["center"], "radius": lamp["radius"],
                         "emitter": {"type": "area", "radiance": rgb((lamp["radiance"],) * 3)}}
        if scene["sky"]:
            d["sky"] = {"type": "constant", "radiance": rgb((scene["sky"],) * 3)}
        start = time.process_time()
        self.scene = mi.load_dict(d)
        self.load = time.process_time() - start

    def render(self, spp, seed):
        import mitsuba as mi, numpy as np
        # Kernels are compiled for a sample count once.
        start = time.process_time()
        image = np.array(mi.render(self.scene, spp=spp, seed=seed)).astype(float)
        return time.process_time() - start, image

    def long(self, spp, seed):
        """In parts: all samples of a call are in memory together."""
        import numpy as np
        parts = max(1, spp // 128)
        return 0.0, np.mean([self.render(spp // parts, seed * 1000 + k)[1] for k in range(parts)], axis=0)


def mask_of(reference):
    import numpy as np
    hot = reference.max(2) > 8
    near = hot.copy()
    for dy in range(-3, 4):
        for dx in range(-3, 4):
            near |= np.roll(np.roll(hot, dy, 0), dx, 1)
    return (reference.max(2) <= 2) & ~near


def measure(args, out):
    import numpy as np
    rows, means = [], []
    for name, scene in scenes(out, args.mesh).items():
        if name not in args.scenes:
            continue
        peers = [Luxel(out, name, scene), Mitsuba(out, name, scene)]
        say(f"{name}: reference of {args.reference_spp} samples")
        half = args.reference_spp // 2
        halves = [peers[0].render(half, 900_001)[1], peers[1].long(half, 901)[1]]
        reference = (halves[0] + halves[1]) / 2
        mask = mask_of(reference)
        weight = reference[mask] ** 2 + 0.01
        # A quarter of the squared difference of two halves is the variance of their mean.
        own = float(((halves[0] - halves[1])[mask] ** 2 / weight).mean()) / 4
        differ = [float(h[mask].mean() / reference[mask].mean() - 1) for h in halves]
        means.append({"scene": name, "masked": float(mask.mean()), "reference_relmse": own, "luxel_mean_off": differ[0]})
        for spp in args.spp:
            peers[1].render(spp, 0)
            for seed in range(1, args.seeds + 1):
                for peer in peers:
                    seconds, image = peer.render(spp, seed)
                    error = float(((image - reference)[mask] ** 2 / weight).mean()) - own
                    rows.append({"scene": name, "peer": peer.name, "spp": spp, "seed": seed, "seconds": seconds,
                                 "load": peer.load, "relmse": error})
            say(f"{name}: {spp} samples done")
        (out / "rows.json").write_text(json.dumps({"references": means, "rows": rows}, indent=1))
    return rows, means


def ladder(rows, scene, peer):
    """Median seconds, mean relMSE and its standard error per sample count."""
    found = {}
    for row in rows:
        if (row["scene"], row["peer"]) == (scene, peer):
            found.setdefault(row["spp"], []).append(row)
    steps = []
    for spp, group in sorted(found.items()):
        seconds = sorted(r["seconds"] for r in group)[len(group) // 2]
        errors = [r["relmse"] for r in group]
        mean = sum(errors) / len(errors)
        spread = math.sqrt(sum((e - mean) ** 2 for e in errors) / max(1, len(errors) - 1) / len(errors))
        steps.append((spp, seconds, mean, spread))
    return steps


def at(steps, x, y, value):
    """Where column y reaches a value: on a line through the two nearest steps, both logarithmic."""
    near = sorted(steps, key=lambda s: abs(math.log(max(s[y], 1e-12) / value)))[:2]
    if len(near) < 2 or near[0][y] == near[1][y]:
        return near[0][x]
    (x0, y0), (x1, y1) = [(math.log(s[x]), math.log(max(s[y], 1e-12))) for s in near]
    return math.exp(x0 + (math.log(value) - y0) * (x1 - x0) / (y1 - y0))


def write_table(rows, means, out):
    lines = ["| scene | paths/s, luxel | Mitsuba | ratio | relMSE | time, luxel | Mitsuba | ratio | load and tree, Mitsuba |",
             "|---|---|---|---|---|---|---|---|---|"]
    for scene in [m["scene"] for m in means]:
        ours, theirs = ladder(rows, scene, "luxel"), ladder(rows, scene, "Mitsuba")
        # Of the longest renders, in which starting hardly counts.
        speed = [SIZE * SIZE * s[-1][0] / s[-1][1] / 1e6 for s in (ours, theirs)]
        target = math.sqrt(theirs[-1][2] * theirs[-2][2]) if len(theirs) > 1 else theirs[-1][2]
        seconds = [at(s, 1, 2, target) for s in (ours, theirs)]
        load = next(r["load"] for r in rows if (r["scene"], r["peer"]) == (scene, "Mitsuba"))
        lines.append(f"| {scene} | {speed[0]:.2f} M | {speed[1]:.2f} M | {speed[0] / speed[1]:.2f} | {target:.2g} | "
                     f"{seconds[0]:.2f} s | {seconds[1]:.2f} s | {seconds[1] / seconds[0]:.2f} | {load:.2f} s |")
    (out / "table.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))
    for m in means:
        print(f'{m["scene"]}: {100 * m["masked"]:.0f} % of the pixels count; the reference\'s own relMSE '
              f'{m["reference_relmse"]:.1e}; luxel\'s half is {100 * m["luxel_mean_off"]:+.3f} % off the mean')


def write_plot(rows, means, out):
    """Time against relMSE, both logarithmic: a panel per scene."""
    width, height, gap = 260, 220, 50
    parts = []
    for k, scene in enumerate(m["scene"] for m in means):
        both = {p: ladder(rows, scene, p) for p in ("luxel", "Mitsuba")}
        points = [(s[1], max(s[2], 1e-9)) for steps in both.values() for s in steps]
        x0, x1 = (math.log10(f(p[0] for p in points)) for f in (min, max))
        y0, y1 = (math.log10(f(p[1] for p in points)) for f in (min, max))
        left = gap + k * (width + gap)
        px = lambda t: left + (math.log10(t) - x0) / max(x1 - x0, 1e-9) * width
        py = lambda e: gap + (y1 - math.log10(max(e, 1e-9))) / max(y1 - y0, 1e-9) * height
        parts.append(f'<rect x="{left}" y="{gap}" width="{width}" height="{height}" fill="none" stroke="#888"/>'
                     f'<text x="{left + width / 2}" y="{gap - 10}" text-anchor="middle">{scene}</text>')
        for e in range(math.ceil(y0), math.floor(y1) + 1):
            parts.append(f'<line x1="{left}" x2="{left + width}" y1="{py(10 ** e):.1f}" y2="{py(10 ** e):.1f}" stroke="#ddd"/>'
                         f'<text x="{left - 4}" y="{py(10 ** e) + 4:.1f}" text-anchor="end">1e{e}</text>')
        for e in range(math.ceil(x0), math.floor(x1) + 1):
            parts.append(f'<line x1="{px(10 ** e):.1f}" x2="{px(10 ** e):.1f}" y1="{gap}" y2="{gap + height}" stroke="#ddd"/>'
                         f'<text x="{px(10 ** e):.1f}" y="{gap + height + 14}" text-anchor="middle">{10 ** e:g} s</text>')
        for peer, colour in (("luxel", "#c33"), ("Mitsuba", "#36c")):
            line = " ".join(f"{px(s[1]):.1f},{py(s[2]):.1f}" for s in both[peer])
            parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
            for s in both[peer]:
                low, high = py(s[2] + 1.96 * s[3]), py(max(s[2] - 1.96 * s[3], 1e-9))
                parts.append(f'<line x1="{px(s[1]):.1f}" x2="{px(s[1]):.1f}" y1="{low:.1f}" y2="{high:.1f}" stroke="{colour}"/>'
                             f'<circle cx="{px(s[1]):.1f}" cy="{py(s[2]):.1f}" r="3" fill="{colour}"/>')
    total = gap + len(means) * (width + gap)
    legend = (f'<text x="{gap}" y="{height + gap + 34}"><tspan fill="#c33">luxel</tspan>, <tspan fill="#36c">Mitsuba 3</tspan>: '
              "relMSE over seconds of processor time, one thread; bars: 95 % intervals over seeds</text>")
    (out / "plot.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg" width="{total}" height="{height + 2 * gap}" '
                                  f'font-family="sans-serif" font-size="11"><rect width="100%" height="100%" fill="white"/>'
                                  + "".join(parts) + legend + "</svg>\n")


def say(line):
    print(line, file=sys.stderr, flush=True)


def arguments():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    names = lambda text: text.split(",")
    p.add_argument("--scenes", type=names, default=["spheres", "glass", "mesh", "terrain"])
    p.add_argument("--mesh", type=lambda f: Path(f).resolve(), help="in place of the bumpy ball; stands in the room as it is")
    p.add_argument("--spp", type=lambda text: [int(n) for n in text.split(",")], default=[4, 16, 64, 256])
    p.add_argument("--seeds", type=int, default=8)
    p.add_argument("--reference-spp", type=int, default=16384)
    p.add_argument("--variant", default="llvm_ad_rgb")
    p.add_argument("--out", type=Path, default=ROOT / "target" / "peers")
    return p.parse_args()


def main():
    args = arguments()
    out = args.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    python = out / "python" / "bin" / "python"
    if Path(sys.prefix).resolve() != (out / "python").resolve():
        if not python.exists():
            say("making a Python environment with Mitsuba")
            venv.create(out / "python", with_pip=True)
            subprocess.run([python, "-m", "pip", "install", "-q", "mitsuba", "numpy", "OpenEXR"], check=True)
        os.execv(python, [str(python), *sys.argv])
    if not (ROOT / "target" / "release" / "luxel").exists():
        sys.exit("no target/release/luxel: run `cargo build --release` first")
    import drjit, mitsuba
    mitsuba.set_variant(args.variant)
    drjit.set_thread_count(1)
    if args.mesh:
        # Scenes name files beside them.
        beside = out / args.mesh.name
        if beside != args.mesh:
            beside.write_bytes(args.mesh.read_bytes())
        args.mesh = beside
    rows, means = measure(args, out)
    write_table(rows, means, out)
    write_plot(rows, means, out)
    say(f"written to {out}")


if __name__ == "__main__":
    main()
