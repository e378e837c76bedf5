"""From plain mesh data to Blender objects: materials, rooms as empties, shells, portals, lights, furniture."""

import math

import bpy
import numpy as np

import catalogue
from geometry import snap, snap_point, sub
from materials import MATERIALS
from openings import Portal
from pictures import PICTURES
from shell import centre_of
from textures import SURFACES

# Blender sums smooth normals of larger meshes on several threads, in no fixed order: the file would differ run by run.
MOST_SMOOTH_FACES = 1000
LIGHT_WATTS = 12.566370614  # the exporter divides a point light's watts by 4 pi to get candelas


FRAMES = 60  # a second


def quaternion(about_z, about_y=0.0):
    """(w, x, y, z) of a turn about z after a turn about y."""
    cz, sz, cy, sy = (f(a / 2) for a in (about_z, about_y) for f in (math.cos, math.sin))
    return (cz * cy, -sz * sy, cz * sy, sz * cy)


def _keys(action, path, axis, frames, values):
    curve = action.fcurves.new(path, index=axis)
    curve.keyframe_points.add(len(frames))
    curve.keyframe_points.foreach_set("co", [number for pair in zip(frames, values) for number in pair])
    for point in curve.keyframe_points:
        point.interpolation = "LINEAR"
    curve.update()


class Scene:
    """The Blender file under construction."""

    def __init__(self):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.context.scene.render.fps = FRAMES
        self.collection = bpy.context.scene.collection
        self.images = {}
        self.materials = {}
        self.data = {}
        self.meshes = {}
        self.rooms = {}
        self.origins = {}

    # ---- materials -------------------------------------------------------------------------------------------------

    def material(self, name):
        if name not in self.materials:
            self.materials[name] = self._new_material(name, MATERIALS[name])
        return self.materials[name]

    def _new_material(self, name, look):
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        material.use_backface_culling = True
        material.diffuse_color = (*look.colour, 1.0)
        nodes, links = material.node_tree.nodes, material.node_tree.links
        shader = nodes["Principled BSDF"]
        target = shader.inputs["Base Color"]
        if look.unlit:
            nodes.remove(shader)
            shader = nodes.new("ShaderNodeBackground")
            links.new(shader.outputs[0], nodes["Material Output"].inputs["Surface"])
            target = shader.inputs["Color"]
        else:
            shader.inputs["Roughness"].default_value = look.rough
            shader.inputs["Specular"].default_value = 0.5
            if look.emission:
                shader.inputs["Emission"].default_value = (*look.colour, 1.0)
                shader.inputs["Emission Strength"].default_value = look.emission
        target.default_value = (*look.colour, 1.0)
        if look.texture:
            picture = nodes.new("ShaderNodeTexImage")
            picture.image = self.image(look.texture)
            links.new(picture.outputs["Color"], target)
        return material

    def image(self, name):
        """The texture as a Blender image, painted the first time it is asked for."""
        if name not in self.images:
            pixels = np.clip((SURFACES | PICTURES)[name](), 0.0, 1.0)
            height, width = pixels.shape[:2]
            image = bpy.data.images.new(name, width, height)
            image.pixels.foreach_set(np.dstack([pixels, np.ones((height, width))]).astype(np.float32).ravel())
            image.pack()
            self.images[name] = image
        return self.images[name]

    # ---- meshes ----------------------------------------------------------------------------------------------------

    def mesh(self, name, data):
        """A Blender mesh from mesh data; texture coordinates are divided by the metres a picture covers."""
        if any(data.smooth) and len(data.faces) > MOST_SMOOTH_FACES:
            raise ValueError(f"{name}: {len(data.faces)} faces, some of them smooth")
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(data.points, [], data.faces)
        names = sorted(set(data.materials))
        for material in names:
            mesh.materials.append(self.material(material))
        slots = {material: i for i, material in enumerate(names)}
        mesh.polygons.foreach_set("material_index", [slots[m] for m in data.materials])
        mesh.polygons.foreach_set("use_smooth", data.smooth)
        layer = mesh.uv_layers.new(name="UVMap")
        flat = []
        for uvs, material in zip(data.uvs, data.materials):
            metres = MATERIALS[material].metres
            flat += [value / metres for uv in uvs for value in uv]
        layer.data.foreach_set("uv", flat)
        mesh.update()
        return mesh

    def piece_data(self, name):
        """Mesh data of a piece of the catalogue, built once."""
        if name not in self.data:
            self.data[name] = catalogue.build(name)
        return self.data[name]

    def piece(self, room_name, object_name, name, at, turn, extras=None):
        """One more object that shares the mesh datablock of its piece, as glTF shares meshes between nodes."""
        if name not in self.meshes:
            self.meshes[name] = self.mesh(name, self.piece_data(name))
        return self.child(room_name, object_name, self.meshes[name], at, turn, extras)

    # ---- objects ---------------------------------------------------------------------------------------------------

    def room(self, room):
        x, y = centre_of(room.footprint)
        origin = (round(x * 8) / 8, round(y * 8) / 8, room.floor)
        empty = self._object(f"{room.name}-room", None, None, origin)
        empty.empty_display_size = 0.5
        empty["label"] = room.label
        empty["theme"] = room.theme
        self.rooms[room.name], self.origins[room.name] = empty, origin

    def child(self, room_name, name, data, at=(0.0, 0.0, 0.0), turn=0.0, extras=None):
        """An object inside a room, placed in the world."""
        item = self._object(name, data, self.rooms[room_name], sub(at, self.origins[room_name]))
        item.rotation_euler = (0.0, 0.0, turn)
        for key, value in (extras or {}).items():
            item[key] = round(value, 3) if isinstance(value, float) else value
        return item

    def _object(self, name, data, parent, location):
        item = bpy.data.objects.new(name, data)
        item.location = location
        item.parent = parent
        self.collection.objects.link(item)
        return item

    def local_mesh(self, room_name, name, data):
        """A mesh of this room alone, given in the world, stored about the room's origin."""
        origin = self.origins[room_name]
        data.points = [sub(p, origin) for p in data.points]
        return self.child(room_name, name, self.mesh(name, data.weld()), origin)

    def portal(self, portal: Portal, number):
        origin = self.origins[portal.source]
        mesh = bpy.data.meshes.new(f"portal.{number}")
        points = [sub(p, origin) for p in portal.points]
        mesh.from_pydata(points, [], [list(range(len(points)))])
        item = self.child(portal.source, f"{portal.target}*{number}-portal", mesh, origin)
        item.hide_render = True

    # ---- what moves ------------------------------------------------------------------------------------------------

    def shared(self, name, build):
        """The Blender mesh of this name, built once."""
        if name not in self.meshes:
            self.meshes[name] = self.mesh(name, build())
        return self.meshes[name]

    def free(self, name, data, at, turn, extras):
        """An object that belongs to no room: it goes through several."""
        item = self._object(name, data, None, at)
        item.rotation_euler = (0.0, 0.0, turn)
        for key, value in extras.items():
            item[key] = round(value, 3) if isinstance(value, float) else value
        return item

    def animate(self, item, rows, origin=(0.0, 0.0, 0.0)):
        """Keys of (seconds, place in the world or None, turn about z, or (turn about z, then about y)), straight between them."""
        turn = item.rotation_euler[2]
        item.rotation_mode = "QUATERNION"
        item.rotation_quaternion = quaternion(turn)
        action = bpy.data.actions.new(item.name)
        item.animation_data_create().action = action
        frames = [row[0] * FRAMES for row in rows]
        if rows[0][1] is not None:
            places = [sub(row[1], origin) for row in rows]
            for axis in range(3):
                _keys(action, "location", axis, frames, [p[axis] for p in places])
        turns = [quaternion(*row[2]) if isinstance(row[2], tuple) else quaternion(row[2]) for row in rows]
        for i in range(1, len(turns)):  # the nearer of q and -q
            if sum(a * b for a, b in zip(turns[i], turns[i - 1])) < 0:
                turns[i] = tuple(-a for a in turns[i])
        for axis in range(4):
            _keys(action, "rotation_quaternion", axis, frames, [q[axis] for q in turns])

    def light(self, room_name, number, at, candela, colour, reach):
        lamp = bpy.data.lights.new(f"{room_name}_light_{number}", "POINT")
        lamp.energy = candela * LIGHT_WATTS
        lamp.color = colour
        lamp.use_custom_distance = True
        lamp.cutoff_distance = reach
        lamp.shadow_soft_size = 0.2
        self.child(room_name, lamp.name, lamp, snap_point(at))

    def spawn(self, room_name, at, turn, eye):
        start = self.child(room_name, "player_start", None, at, turn, {"classname": "info_player_start"})
        camera = bpy.data.objects.new("player_camera", bpy.data.cameras.new("player_camera"))
        camera.location = (0.0, 0.0, snap(eye))
        camera.rotation_euler = (1.5707963267948966, 0.0, 0.0)
        camera.parent = start
        self.collection.objects.link(camera)

    def export(self, path):
        bpy.ops.export_scene.gltf(
            filepath=path,
            export_format="GLB",
            export_extras=True,
            export_lights=True,
            export_cameras=True,
            export_apply=False,
            export_yup=True,
            export_animations=True,
            export_force_sampling=False,
            export_frame_range=False,
            export_nla_strips=False,
            export_skins=False,
            export_morph=False,
            export_image_format="JPEG",
            convert_lighting_mode="COMPAT",
        )
