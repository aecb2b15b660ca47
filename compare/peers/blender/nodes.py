# Builds trees of Blender's shader nodes. Where the names of Blender 3.x and 4.x differ, a tuple lists the alternatives,
# and the first that exists is used.
import bpy

WHITE = (1.0, 1.0, 1.0, 1.0)


def first_known(owner, name, *values):
    """Sets a property to the first of the values that this version of Blender supports."""
    for value in values:
        try:
            setattr(owner, name, value)
            return
        except TypeError:
            pass
    raise RuntimeError(f"Blender {bpy.app.version_string}: {name} can be none of {', '.join(map(str, values))}")


def set_where_known(value, name, *owners):
    """Sets a property of the first owner that has it, or of none if newer versions have removed it."""
    for owner in owners:
        if hasattr(owner, name):
            setattr(owner, name, value)
            return


def rgba(color):
    return (color[0], color[1], color[2], 1.0)


class Nodes:
    """Builds a node tree bottom-up: add(...) returns an output socket."""

    def __init__(self, owner):
        owner.use_nodes = True
        self.tree = owner.node_tree
        self.tree.nodes.clear()

    def add(self, kind, output=0, settings=None, **inputs):
        node = self.new_node(kind)
        for name, value in (settings or {}).items():
            first_known(node, name, *(value if isinstance(value, tuple) else (value,)))
        for name, value in inputs.items():
            key = int(name[1:]) if name[0] == "_" and name[1:].isdigit() else name.replace("_", " ")
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node.outputs[output]

    def new_node(self, kind):
        kinds = kind if isinstance(kind, tuple) else (kind,)
        for kind in kinds:
            if hasattr(bpy.types, kind):
                return self.tree.nodes.new(kind)
        raise RuntimeError(f"Blender {bpy.app.version_string} has no node {' or '.join(kinds)}")

    def math(self, operation, *values):
        return self.add("ShaderNodeMath", 0, {"operation": operation}, **{f"_{i}": v for i, v in enumerate(values)})

    def dot(self, a, b):
        return self.add("ShaderNodeVectorMath", "Value", {"operation": "DOT_PRODUCT"}, _0=a, _1=b)

    def mix(self, factor, a, b):
        return self.add("ShaderNodeMixRGB", 0, {}, Fac=factor, Color1=a, Color2=b)

    def multiply(self, a, b):
        return self.add("ShaderNodeMixRGB", 0, {"blend_type": "MULTIPLY"}, Fac=1.0, Color1=a, Color2=b)

    def sum(self, shaders):
        total = shaders[0]
        for other in shaders[1:]:
            total = self.add("ShaderNodeAddShader", 0, {}, _0=total, _1=other)
        return total

    def output(self, kind, **shaders):
        """Links shaders to the tree's output node, which the first call makes."""
        made = [node for node in self.tree.nodes if node.bl_idname == kind]
        node = made[0] if made else self.tree.nodes.new(kind)
        for name, shader in shaders.items():
            self.tree.links.new(shader, node.inputs[name])
