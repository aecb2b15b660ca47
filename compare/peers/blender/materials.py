# Makes Blender's materials.
import bpy
from exported import EEVEE, load_image
from nodes import WHITE, Nodes, rgba

GLOSSY = ("ShaderNodeBsdfGlossy", "ShaderNodeBsdfAnisotropic")  # since 4.0, the second name is for both
SHARP = ("SHARP", "GGX")  # since 4.0, a roughness of 0 is used instead of SHARP


def texture(nodes, t):
    uv = nodes.add("ShaderNodeUVMap", 0, {"uv_map": "uv"})
    if t["type"] == "image":
        scaled = nodes.add("ShaderNodeVectorMath", 0, {"operation": "MULTIPLY"}, _0=uv,
                           _1=(t["scale"][0], t["scale"][1], 1.0))
        settings = {"image": load_image(t["file"]), "interpolation": "Linear" if t["bilinear"] else "Closest"}
        return nodes.add("ShaderNodeTexImage", "Color", settings, Vector=scaled)
    place = nodes.add("ShaderNodeAttribute", "Vector", {"attribute_name": "p_object"}) if t["solid"] else uv
    # Cycles' checker is three-dimensional. It uses Color2 where the sum of the cell indices is even.
    shift = 1.0 / 4096 if t["solid"] else 0.0
    moved = nodes.add("ShaderNodeVectorMath", 0, {"operation": "MULTIPLY_ADD"}, _0=place, _1=(t["scale"],) * 3,
                      _2=(shift,) * 3)
    return nodes.add("ShaderNodeTexChecker", "Color", {}, Vector=moved, Scale=1.0, Color1=rgba(t["odd"]),
                     Color2=rgba(t["even"]))


def slot(nodes, s):
    if s["texture"] is None:
        return rgba(s["value"])
    return nodes.multiply(texture(nodes, s["texture"]), rgba(s["value"]))


def metal(nodes, m):
    # This is Schlick's Fresnel term at the shading normal, which is exact for a mirror.
    geometry = nodes.tree.nodes.new("ShaderNodeNewGeometry")
    cosine = nodes.math("ABSOLUTE", nodes.dot(geometry.outputs["Incoming"], geometry.outputs["Normal"]))
    grazing = nodes.math("POWER", nodes.math("SUBTRACT", 1.0, cosine), 5.0)
    color = nodes.mix(grazing, slot(nodes, m["slot"]), WHITE)
    smooth = m["roughness"] ** 2 < 1e-4
    # In Blender, too, alpha is the square of the roughness. Duet's metal includes multiple scattering, as MULTI_GGX.
    return nodes.add(GLOSSY, 0, {"distribution": SHARP if smooth else "MULTI_GGX"}, Color=color,
                     Roughness=0.0 if smooth else m["roughness"])


def clear_glass(m):
    return m["slot"]["texture"] is None and all(channel == 1.0 for channel in m["slot"]["value"])


def dielectric(nodes, m):
    # Blender's rough glass matches Duet's: it has the Fresnel term at the microfacet and conserves energy. But it also
    # tints reflections, so it is used for clear glass only.
    rough = m["roughness"]
    if rough > 0 and clear_glass(m):
        return nodes.add("ShaderNodeBsdfGlass", 0, {"distribution": "MULTI_GGX"}, Color=WHITE, IOR=m["ior"],
                         Roughness=rough)
    lobe = {"distribution": "GGX" if rough > 0 else SHARP}
    through = nodes.add("ShaderNodeBsdfRefraction", 0, lobe, Color=slot(nodes, m["slot"]), IOR=m["ior"],
                        Roughness=rough)
    back = nodes.add(GLOSSY, 0, lobe, Color=WHITE, Roughness=rough)
    return nodes.add("ShaderNodeMixShader", 0, {}, Fac=nodes.add("ShaderNodeFresnel", 0, {}, IOR=m["ior"]), _1=through,
                     _2=back)


def absorption(nodes, m):
    # Blender's absorption coefficient is (1 - color)*density.
    sigma = m.get("absorption", (0.0, 0.0, 0.0))
    density = max(sigma)
    if density == 0.0:
        return None
    return nodes.add("ShaderNodeVolumeAbsorption", 0, {}, Color=rgba([1.0 - s / density for s in sigma]),
                     Density=density)


def principled(nodes, m):
    # In Blender, specular 0.5 means a reflectance of 0.04 at normal incidence.
    normal = ((m["ior"] - 1.0) / (m["ior"] + 1.0)) ** 2
    inputs = {"Base_Color": slot(nodes, m["slot"]), "Metallic": m["metallic"], "Roughness": m["roughness"]}
    if bpy.app.version < (4, 0, 0):
        # Blender's coat is a quarter of a coat with index 1.5. Values above 1 are only possible through a link.
        coat = nodes.math("MULTIPLY", 4.0, m["clearcoat"]) if m["clearcoat"] > 0.0 else 0.0
        inputs |= {"Specular": normal / 0.08, "Clearcoat": coat, "Clearcoat_Roughness": m["clearcoat_roughness"]}
    else:
        inputs |= {"IOR": m["ior"], "Coat_Weight": m["clearcoat"], "Coat_Roughness": m["clearcoat_roughness"]}
    properties = {"distribution": "MULTI_GGX"}
    if "subsurface" in m:
        weight, radius = m["subsurface"]["weight"], m["subsurface"]["radius"]
        properties["subsurface_method"] = "RANDOM_WALK"
        if bpy.app.version < (4, 0, 0):
            inputs |= {"Subsurface": weight, "Subsurface_Color": slot(nodes, m["slot"]), "Subsurface_Radius": radius}
        else:
            inputs |= {"Subsurface_Weight": weight, "Subsurface_Radius": radius, "Subsurface_Scale": 1.0}
    return nodes.add("ShaderNodeBsdfPrincipled", 0, properties, **inputs)


def emissive(nodes, m):
    strength = 1.0
    if not m["two_sided"]:
        strength = nodes.math("SUBTRACT", 1.0, nodes.add("ShaderNodeNewGeometry", "Backfacing"))
    light = nodes.add("ShaderNodeEmission", 0, {}, Color=rgba(m["radiance"]), Strength=strength)
    if m["slot"]["texture"] is None and not any(m["slot"]["value"]):
        return light
    reflected = nodes.add("ShaderNodeBsdfDiffuse", 0, {}, Color=slot(nodes, m["slot"]), Roughness=0.0)
    return nodes.sum([light, reflected])


def diffuse(nodes, m):
    return nodes.add("ShaderNodeBsdfDiffuse", 0, {}, Color=slot(nodes, m["slot"]), Roughness=0.0)


def make_material(m):
    material = bpy.data.materials.new(m["name"])
    nodes = Nodes(material)
    surface = {"diffuse": diffuse, "metal": metal, "dielectric": dielectric, "principled": principled,
               "emissive": emissive}[m["type"]](nodes, m)
    nodes.output("ShaderNodeOutputMaterial", Surface=surface)
    if EEVEE:
        material.use_screen_refraction = m["type"] == "dielectric"
        if m["type"] == "emissive":
            material.shadow_method = "NONE"  # the light in place of this surface would be in its shadow
    inside = absorption(nodes, m)
    if inside is not None:
        nodes.output("ShaderNodeOutputMaterial", Volume=inside)
    return material
