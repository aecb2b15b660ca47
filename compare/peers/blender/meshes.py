# Makes Blender's meshes and objects.
import array

import bpy
from exported import read_array
from mathutils import Matrix
from nodes import set_where_known


def make_mesh(name, part):
    mesh = bpy.data.meshes.new(name)
    positions, triangles = read_array("f", part["positions"]), read_array("i", part["triangles"])
    count = len(triangles) // 3
    mesh.vertices.add(len(positions) // 3)
    mesh.vertices.foreach_set("co", positions)
    mesh.loops.add(3 * count)
    mesh.loops.foreach_set("vertex_index", triangles)
    mesh.polygons.add(count)
    mesh.polygons.foreach_set("loop_start", array.array("i", range(0, 3 * count, 3)))
    if bpy.app.version < (3, 6):  # later versions derive it from loop_start
        mesh.polygons.foreach_set("loop_total", array.array("i", [3]) * count)
    mesh.polygons.foreach_set("material_index", read_array("i", part["slots"]))
    mesh.polygons.foreach_set("use_smooth", array.array("b", [1 if part["normals"] else 0]) * count)
    if part["uvs"]:
        mesh.uv_layers.new(name="uv").data.foreach_set("uv", read_array("f", part["uvs"]))
    if part["p_object"]:
        mesh.attributes.new("p_object", "FLOAT_VECTOR", "CORNER").data.foreach_set("vector",
                                                                                   read_array("f", part["p_object"]))
    mesh.update(calc_edges=True)
    if part["normals"]:
        normals = read_array("f", part["normals"])
        set_where_known(True, "use_auto_smooth", mesh)  # since 4.1, the corners' normals are always used
        mesh.normals_split_custom_set([normals[i:i + 3] for i in range(0, len(normals), 3)])
    if len(mesh.polygons) != count:
        raise RuntimeError(f"{name}: Blender made {len(mesh.polygons)} of {count} triangles")
    return mesh


def make_objects(scene, materials):
    """Returns Blender's objects, in the order of the scene's."""
    meshes = [make_mesh(part["name"], part) for part in scene["meshes"]]
    things = []
    for o in scene["objects"]:
        mesh = meshes[o["mesh"]]
        while len(mesh.materials) < len(o["materials"]):
            mesh.materials.append(None)
        thing = bpy.data.objects.new(o["name"], mesh)
        things.append(thing)
        bpy.context.collection.objects.link(thing)
        for i, index in enumerate(o["materials"]):
            thing.material_slots[i].link = "OBJECT"
            thing.material_slots[i].material = materials[index]
        thing.matrix_world = Matrix(o["matrix"])
        set_where_known(0.0, "shadow_terminator_offset", thing.cycles)
        set_where_known(0.0, "shadow_terminator_normal_offset", thing)
        set_where_known(0.0, "shadow_terminator_geometry_offset", thing.cycles, thing)
    return things
