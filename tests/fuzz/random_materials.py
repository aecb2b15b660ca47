"""Random textures and materials of the scenes of random_scenes.py, as JSON values."""
from random_values import RandomValues
from scene_assets import IMAGES

CONDUCTORS = ["aluminium", "chromium", "cobalt", "copper", "gold", "iron", "nickel", "palladium", "platinum", "silver",
              "titanium", "tungsten"]
SOLIDS = ["apple", "chicken", "cream", "ketchup", "marble", "potato", "skimmed-milk", "skin", "skin-pale", "whole-milk"]


class RandomMaterials(RandomValues):
    def __init__(self, seed):
        super().__init__(seed)
        self.textures = {}  # by name

    def texture(self):
        kind = self.pick(["image", "image", "checker", "noise"])
        scale = self.pick([1, self.uniform(0.1, 20), self.log_uniform(1e-9, 1e9)])
        if kind == "image":
            return {"type": kind, "file": self.pick(IMAGES), **self.some({
                "scale": self.pick([scale, [scale, -2], [-0.5, scale]]),
                "filter": self.pick(["nearest", "bilinear", "trilinear", "anisotropic"]),
                "values": self.pick(["colors", "data"]),
                "channel": self.pick(["all", "red", "green", "blue", "alpha"])})}
        if kind == "checker":
            keys = {"even": self.color(), "odd": self.color(), "scale": scale, "solid": self.chance(0.5)}
        else:
            keys = {"low": self.color(), "high": self.color(), "scale": scale, "marble": self.chance(0.5),
                    "octaves": self.pick([1, 16, self.random.randint(2, 8)])}
        return {"type": kind, **self.some(keys)}

    def texture_name(self):
        return self.pick(sorted(self.textures))

    def slot(self):
        if self.textures and self.chance(0.4):
            return {"texture": self.texture_name(), **self.some({"tint": self.color()})}
        return self.color()

    def scalar(self):
        if self.textures and self.chance(0.3):
            return {"texture": self.texture_name(), **self.some({"scale": self.fraction()})}
        return self.fraction()

    def map(self):
        """The value of a normal or bump map."""
        scale = self.pick([1, -1, 0, 0.01 * self.unit, self.uniform(-5, 5), self.log_uniform(1e-9, 1e9)])
        return {"texture": self.texture_name(), **self.some({"scale": scale})}

    def ior(self):
        return self.pick([1, 1.33, 1.5, 4, self.uniform(1, 4)])

    def metal(self):
        if self.chance(0.5):
            return {"conductor": self.pick(CONDUCTORS), **self.some({"roughness": self.scalar()})}
        return self.some({"reflectance": self.slot(), "roughness": self.scalar()})

    def dielectric(self):
        keys = self.some({"tint": self.slot(), "ior": self.ior()})
        if self.chance(0.3):
            return keys | {"thin": True}
        absorption = {"color": self.color(), "distance": max(1e-9, self.size())}
        return keys | self.some({"roughness": self.scalar(), "absorption": absorption, "thin": False,
                                 "priority": self.pick([0, 1, 2, self.random.randint(0, 100)])})

    def subsurface(self):
        keys = self.some({"roughness": self.scalar(), "ior": self.ior()})
        if self.chance(0.3):
            return keys | {"measured": self.pick(SOLIDS), **self.some({"scale": self.size()})}
        return keys | {"mean_free_path": self.mean_free_path(), **self.some({"albedo": self.slot()})}

    def mean_free_path(self):
        return self.pick([0, self.size(), [self.size(), 0, self.size()], self.power(0.1 * self.unit)])

    def emissive(self):
        keys = {"radiance": self.power(5), **self.some({"two_sided": self.chance(0.5), "albedo": self.slot()})}
        if self.textures and self.chance(0.5):
            keys["radiance_texture"] = self.texture_name()
        return keys

    def material(self):
        kind = self.pick(["diffuse", "metal", "dielectric", "principled", "coated", "subsurface", "emissive"])
        slot, scalar = self.slot(), self.scalar()
        if kind in ("metal", "dielectric", "subsurface", "emissive"):
            keys = getattr(self, kind)()
        elif kind == "diffuse":
            keys = self.some({"albedo": slot, "roughness": scalar})
        elif kind == "coated":
            keys = self.some({"albedo": slot, "roughness": scalar, "ior": self.ior()})
        else:
            keys = self.some({"base_color": slot, "roughness": scalar, "ior": self.ior(), "metallic": self.scalar(),
                              "clearcoat": self.scalar(), "clearcoat_roughness": self.scalar()})
            if self.chance(0.2):
                keys |= {"subsurface": self.scalar(), "mean_free_path": self.mean_free_path()}
        if self.textures:
            keys |= self.some({"normal": self.map(), "bump": self.map()}, 0.15)
        if kind != "emissive":
            keys |= self.some({"opacity": self.scalar(), "cutoff": self.fraction()}, 0.15)
        return {"type": kind, **keys}
