#!/usr/bin/env python3
"""Writes random scene files, all of them valid, for stress tests of the programs that read them. They follow
models/README.md alone, so that a scene that a program refuses shows a difference from the documentation. The only
addition is that a box has an extent, and a camera a direction, in single precision, too.

  random_scenes.py FOLDER --count N --seed S

writes FOLDER/scene-S-I.json for I from 0 to N - 1, and the meshes and images that they use into the same folder. The
path of each scene goes to standard output as soon as the file is complete:

  random_scenes.py /tmp/scenes --count 100 --seed 1 | while read -r f; do raster "$f" --size 8x8 -o /tmp/x.png; done

A seed always gives the same files. Scene I of a seed does not depend on N.
"""
import argparse
import copy
import json
import math
import pathlib

from random_materials import RandomMaterials
from random_values import LARGEST, cross, length, plus, short, single
from scene_assets import ENVIRONMENTS, MESHES, SMOKE, SMOKE_POINTS, write_assets

REACH = 1e12  # No object reaches farther from the eye than a few times this many distances to what it looks at.


class Scene(RandomMaterials):
    """One random scene. Most methods return a part of the file as a JSON value."""

    def __init__(self, seed, index):
        super().__init__(f"{seed}/{index}")
        self.materials = {}
        self.shapes, self.groups, self.places = [], [], [self.center]
        self.names = 0
        # A product of two matrices that both change could be singular midway. So only one kind of object moves, unless
        # all motions are translations.
        self.movers = self.random.choices([None, "shape", "group", "instance", "all"], [8, 5, 2, 2, 3])[0]

    # Transforms and motion.

    def pivoted(self, steps):
        """The steps about the center of the scene in place of the origin, so that the object stays there."""
        if not steps or self.center == [0, 0, 0]:
            return steps
        return [{"translate": [-x for x in self.center]}, *steps, {"translate": self.center}]

    def factor(self):
        """A positive factor of a scale."""
        return self.log_uniform(*self.scales)

    def matrix(self):
        """A step with a matrix whose diagonal is positive, and larger than the rest of its row. So it is not singular,
        and no mean of two such matrices is."""
        entries = []
        for i in range(3):
            row = [self.uniform(0.85, 1) if i == j else self.uniform(-0.4, 0.4) for j in range(3)]
            factor = self.factor()
            entries += [short(factor * x) for x in row] + [short(self.uniform(-1, 1) * self.unit)]
        return {"matrix": entries + [0, 0, 0, 1]}

    def step(self):
        kind = self.pick(["translate", "scale", "rotate", "matrix"])
        if kind == "translate":
            return {"translate": self.direction(self.unit)}
        if kind == "scale":
            factors = [self.factor() * self.pick([-1, 1, 1]) for _ in range(3)]
            return {"scale": self.pick([factors, factors[0]])}
        if kind == "rotate":
            return {"rotate_degrees": self.pick([90, 180, -45, self.uniform(-400, 400)]), "axis": self.any_length()}
        return self.matrix()

    def motion(self, steps):
        """The transforms at times 0 and 1. Between them, none is singular: they differ by one step that is a
        translation, a turn of less than 180 degrees, a scale by positive factors, or a matrix as matrix() makes."""
        kind = self.pick(["translate", "turn", "scale", "matrix"])
        if self.movers == "all" or kind == "translate":
            return steps, steps + [{"translate": self.direction(self.unit * self.log_uniform(0.01, 3))}]
        if kind == "matrix":
            return steps + self.pivoted([self.matrix()]), steps + self.pivoted([self.matrix()])
        step = {"scale": [self.factor() for _ in range(3)]}
        if kind == "turn":
            step = {"rotate_degrees": self.uniform(-170, 170), "axis": self.any_length()}
        return steps, self.pick([steps + self.pivoted([step]), [step] + steps])

    def set_transform(self, item, kind, depth, steps=()):
        """Gives an object these steps, perhaps further ones, and perhaps a motion."""
        steps = list(steps)
        if self.chance(0.9 if kind == "instance" else 0.4):
            steps += self.pivoted([self.step() for _ in range(self.random.randint(1, 3))])
        moves = self.movers == "all" or self.movers == kind and (kind == "shape" or depth == 0)
        if moves and self.chance(0.5):
            steps, item["transform_end"] = self.motion(steps)
        if steps:
            item["transform"] = steps

    # Objects.

    def name(self):
        self.names += 1
        return self.pick(["object {}", "größe-{}", "{}", "a\"b\\{}", "object_{}"]).format(self.names)

    def quad(self):
        u, across = self.direction(self.size()), self.direction()
        while length(cross(u, across)) < 0.1 * length(u):
            across = self.direction()
        narrow = length(u) * self.pick([1, self.log_uniform(0.001, 1)])
        v = [short(narrow * x) for x in across]
        return {"corner": plus(plus(self.places[-1], u, -0.5), v, -0.5), "u": u, "v": v}

    def box(self):
        half = self.size() / 2
        if self.chance(0.08):  # A huge box below the others, whose top is at the height of the center.
            half = min(half * self.log_uniform(1e3, 1e6), LARGEST)
            self.reach = max(self.reach, half)
            self.places[-1] = plus(self.center, [0, -half, 0])
        while True:
            sides = [half * self.pick([1, self.log_uniform(0.01, 1)]) for _ in range(3)]
            low, high = plus(self.places[-1], sides, -1), plus(self.places[-1], sides)
            if all(single(a) < single(b) for a, b in zip(low, high)):
                return {"low": low, "high": high}
            half *= 10  # A small box far from the origin has no extent in single precision.

    def shape(self, depth):
        if self.shapes and self.chance(0.12):  # Two surfaces at the same place.
            item = copy.deepcopy(self.pick(self.shapes))
            item.pop("name", None)
            return item | ({"material": self.pick(sorted(self.materials))} if "material" in item else {})
        kind = self.pick(["quad", "sphere", "box", "mesh"])
        self.places.append(self.place())
        item, steps = {"type": kind, **self.some({"name": self.name()}, 0.3)}, []
        if kind == "mesh":
            item |= {"file": self.pick(MESHES), **self.some({"normals": self.pick(["file", "flat", "smooth"])})}
            steps = [{"scale": self.size()}, {"translate": self.places[-1]}]
        elif kind == "sphere":
            item |= {"center": self.places[-1], "radius": self.size()}
        else:
            item |= self.quad() if kind == "quad" else self.box()
        if kind != "mesh" or self.chance(0.6):
            item["material"] = self.pick(sorted(self.materials))
        self.set_transform(item, "shape", depth, steps)
        self.shapes.append(item)
        return item

    def group(self, depth, count):
        item = {"type": "group", "objects": self.objects(depth + 1, count)}
        if self.chance(0.7):
            item |= {"name": self.name(), **self.some({"hidden": self.chance(0.7)})}
            self.groups.append(item["name"])
        self.set_transform(item, "group", depth)
        return item

    def instance(self, depth):
        item = {"type": "instance", "of": self.pick(self.groups), **self.some({"name": self.name()}, 0.3)}
        self.set_transform(item, "instance", depth)
        return item

    def objects(self, depth, count):
        """A list of objects, count with those in its groups. Instances in groups show groups that are complete, so no
        group shows itself. The list of the file has instances of later groups, too."""
        made = []
        while count > 0:
            used = 1
            if depth > 0 and self.groups and self.movers != "group" and self.chance(0.15):
                made.append(self.instance(depth))
            elif count > 1 and depth < 4 and self.chance(0.25):
                used = self.random.randint(2, count)
                made.append(self.group(depth, used - 1))
            else:
                made.append(self.shape(depth))
            count -= used
        for _ in range(self.random.randint(0, 3) if depth == 0 and self.groups else 0):
            made.insert(self.random.randint(0, len(made)), self.instance(depth))
        return made

    # The camera, lights and environment.

    def view(self):
        """The eye and the point that it looks at: before the scene, inside an object, very close, or far away."""
        kind = self.random.choices(["before", "inside", "close", "far"], [6, 2, 1, 1])[0]
        at = self.pick(self.places)
        distance = {"before": 5 * self.unit, "inside": self.unit, "close": self.uniform(1e-6, 9e-6),
                    "far": min(self.unit * self.log_uniform(10, 1e4), LARGEST)}[kind]
        distance = max(distance, self.reach / REACH)
        while True:
            other = plus(at, self.direction(distance))
            # In single precision, the eye and the point differ by about the distance. Otherwise the view's direction
            # is not the one that up is chosen for.
            if math.dist([single(x) for x in other], [single(x) for x in at]) > 0.5 * distance:
                return (at, other) if kind == "inside" else (other, at)
            distance *= 10

    def camera(self):
        eye, look_at = ([single(x) for x in point] for point in self.view())
        view = plus(look_at, eye, -1)
        up = [0, 1, 0] if self.chance(0.6) else self.any_length()
        while length(cross(up, view)) < 0.01 * length(up) * length(view):
            up = self.any_length()
        near, radius, focus = (self.pick([0, length(view) * self.log_uniform(*part)])
                               for part in ((1e-6, 0.5), (1e-4, 0.3), (0.01, 100)))
        keys = {"eye": eye, "look_at": look_at, **({"up": up} if up != [0, 1, 0] or self.chance(0.5) else {})}
        keys |= self.some({"near": near, "shutter": sorted([self.fraction(), self.fraction()])}, 0.3)
        if self.chance(0.25):
            height = max(self.unit, self.reach / REACH) * self.uniform(0.1, 8)
            return {"projection": "orthographic", **keys, **self.some({"height": height})}
        fov = self.pick([0.001, 179, self.uniform(5, 100), self.uniform(20, 70), self.uniform(20, 70)])
        return keys | self.some({"projection": "perspective", "fov_degrees": fov, "aperture_radius": radius,
                                 "focus_distance": focus})

    def light(self):
        kind = self.pick(["point", "spot", "sun"])
        if kind == "sun":
            return {"type": kind, "direction": self.any_length(), "irradiance": self.power(3)}
        light = {"type": kind, "position": self.place(), "intensity": self.power(10 * self.unit ** 2)}
        if kind == "spot":
            light["direction"] = self.any_length()
            inner = self.uniform(0, 90)
            light |= self.pick([{}, {"inner_degrees": self.uniform(0, 29)}, {"outer_degrees": self.uniform(21, 180)},
                                {"inner_degrees": 0, "outer_degrees": 180},
                                {"inner_degrees": inner, "outer_degrees": inner + self.uniform(0.01, 90)}])
        return light

    def environment(self):
        kind = self.pick(["constant", "sky", "image"])
        if kind == "constant":
            return {"type": kind, "radiance": self.power(1)}
        if kind == "sky":
            return {"type": kind, **self.some({"down": self.power(1), "up": self.power(1)})}
        return {"type": kind, "file": self.pick(ENVIRONMENTS), **self.some({
            "scale": self.pick([0, 1, self.uniform(0.1, 10), self.log_uniform(1e-6, 1e6)]),
            "rotate_degrees": self.pick([90, self.uniform(-720, 720), LARGEST])})}

    def medium(self):
        """Fog in a box, in a part of space that is open on some sides, or everywhere; a cloud; smoke."""
        self.places.append(self.place())
        coefficients = self.some({
            "scattering": self.power(0.3 / self.unit), "absorption": self.power(0.3 / self.unit),
            "radiance": self.power(1), "asymmetry": self.pick([-0.99, 0, 0.99, self.uniform(-0.9, 0.9)])}, 0.6)
        kind = self.pick(["fog", "cloud", "smoke"])
        if kind == "fog":
            return {"type": kind, **self.some(self.box(), 0.9), **coefficients}
        if kind == "smoke":
            return {"type": kind, **self.box(), "file": SMOKE, "resolution": SMOKE_POINTS, **coefficients}
        return {"type": kind, **self.box(), "resolution": self.random.randint(1, 24), **coefficients, **self.some({
            "scale": self.log_uniform(0.1, 10) / self.unit, "octaves": self.random.randint(1, 16),
            "coverage": self.fraction(), "softness": self.log_uniform(1e-3, 1e3)}, 0.6)}

    def file(self):
        """The whole scene. The order of its keys is random."""
        for n in range(self.random.randint(0, 5)):
            self.textures[f"texture {n}"] = self.texture()
        for n in range(self.random.randint(1, 7)):
            self.materials[f"material {n}"] = self.material()
        count = 0 if self.chance(0.02) else self.random.randint(1, 12)
        scene = {"objects": self.objects(0, count), "materials": self.materials, "camera": self.camera()}
        if self.textures:
            scene["textures"] = self.textures
        scene |= self.some({"lights": [self.light() for _ in range(self.random.randint(0, 4))],
                            "environment": self.environment()}, 0.7)
        scene |= self.some({"media": [self.medium() for _ in range(self.random.randint(0, 3))]}, 0.25)
        scene |= self.some({"image": {"width": self.random.randint(1, 64), "height": self.random.randint(1, 64)},
                            "description": f"Sizes about {self.unit:.3g} m.", "$schema": "scene.schema.json"}, 0.3)
        return {key: scene[key] for key in self.random.sample(list(scene), len(scene))}


def main():
    parser = argparse.ArgumentParser(description="Writes random valid scene files and prints their paths.")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=10, help="number of scenes (default 10)")
    parser.add_argument("--seed", type=int, default=0, help="seed of the random numbers (default 0)")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    write_assets(options.folder)
    for index in range(options.count):
        path = options.folder / f"scene-{options.seed}-{index}.json"
        scene = Scene(options.seed, index).file()
        path.write_text(json.dumps(scene, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        print(path, flush=True)


if __name__ == "__main__":
    main()
