"""Blender's cloth on a sheet of bench/continuum and bench/peers (peer_blender.cpp), run by Blender itself:

  blender -b -t 1 --factory-startup -P blender_cloth.py -- SHEET.json TOLD.json

SHEET.json says what the sheet is; TOLD.json gets, for each of its `runs`, the milliseconds of stepping through all
frames (without starting Blender or building the sheet) and the positions at the end, none where it blew up.

Blender's cloth has its own units. Its time goes by in frames, whatever their rate; gravity is multiplied by 0.001
of them, a spring's stiffness is divided by the mean length of the edges, air drag counts a hundredth, for each
vertex, and a hinge between two squares is as stiff as a twentieth of the bending stiffness times a square's area.
These came of the fall of a particle, the length of a hanging spring and the angle of a flap by its weight. A frame
here stands for `seconds` over the number of frames, and all values are converted to it, so that any number of frames
says the same of the cloth. The substeps of a frame are a power of two: for others Blender's sum of their lengths in
single precision may fall short of the frame, and one more is done.
"""
import json
import math
import sys
import time

import bpy


def place(sheet, i, j):
    return [o + u * i / (sheet["nx"] - 1) + v * j / (sheet["ny"] - 1)
            for o, u, v in zip(sheet["origin"], sheet["u"], sheet["v"])]


def make_sheet(sheet):
    nx, ny = sheet["nx"], sheet["ny"]
    points = [place(sheet, i, j) for j in range(ny) for i in range(nx)]
    faces = [(j * nx + i, j * nx + i + 1, (j + 1) * nx + i + 1, (j + 1) * nx + i)
             for j in range(ny - 1) for i in range(nx - 1)]
    mesh = bpy.data.meshes.new("sheet")
    mesh.from_pydata(points, [], faces)
    mesh.update()
    cloth = bpy.data.objects.new("sheet", mesh)
    bpy.context.scene.collection.objects.link(cloth)
    held = cloth.vertex_groups.new(name="held")
    held.add(sheet["held"], 1.0, "REPLACE")
    return cloth


def turn_ends(cloth, sheet, frames):
    """Hooks to empties that turn, with a key in every frame."""
    for n, turn in enumerate(sheet["turns"]):
        empty = bpy.data.objects.new(f"turn{n}", None)
        bpy.context.scene.collection.objects.link(empty)
        empty.location = turn["about"]
        empty.rotation_mode = "AXIS_ANGLE"
        group = cloth.vertex_groups.new(name=f"turn{n}")
        group.add(turn["vertices"], 1.0, "REPLACE")
        bpy.context.view_layer.update()
        hook = cloth.modifiers.new(f"turn{n}", "HOOK")
        hook.vertex_group = group.name
        hook.object = empty
        hook.matrix_inverse = empty.matrix_world.inverted()
        for frame in range(frames + 1):
            at = frame / frames * (len(turn["degrees"]) - 1)  # keys are evenly spaced over the run
            key = min(int(at), len(turn["degrees"]) - 2)
            a, b = turn["degrees"][key:key + 2]
            empty.rotation_axis_angle = [math.radians(a + (b - a) * (at - key)), *turn["axis"]]
            empty.keyframe_insert("rotation_axis_angle", frame=frame + 1)
        for curve in empty.animation_data.action.fcurves:
            for point in curve.keyframe_points:
                point.interpolation = "LINEAR"


def add_ball(ball):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=128, ring_count=64, radius=ball["radius"], location=ball["center"])
    it = bpy.context.object
    it.modifiers.new("collision", "COLLISION")
    it.collision.thickness_outer = 0.001  # the least that it takes
    it.collision.cloth_friction = 100 * ball["friction"]  # it counts a hundredth
    it.collision.damping = 0


def set_cloth(cloth, sheet, frames, substeps):
    unit = sheet["seconds"] / frames  # s, of Blender's time
    edges = [math.dist(cloth.data.vertices[a].co, cloth.data.vertices[b].co)
             for a, b in (e.vertices for e in cloth.data.edges)]
    length = sum(edges) / len(edges)
    modifier = cloth.modifiers.new("cloth", "CLOTH")
    s = modifier.settings
    s.vertex_group_mass = "held"
    s.quality = substeps
    s.mass = sheet["mass"]
    s.air_damping = 100 * sheet["mass"] * sheet["drag"] * unit
    for kind in ("tension", "compression", "shear", "bending"):
        setattr(s, kind + "_damping", 0)
    for kind, stiffness in (("tension", sheet["structural"]), ("compression", sheet["structural"]),
                            ("shear", sheet["shear"])):
        setattr(s, kind + "_stiffness", stiffness * length * unit**2)
    s.bending_model = "ANGULAR"
    s.bending_stiffness = 20 * sheet["bending"] * unit**2 / length**2
    modifier.collision_settings.use_collision = sheet["ball"] is not None
    if sheet["ball"]:
        modifier.collision_settings.distance_min = 0.001
    scene = bpy.context.scene
    scene.gravity = [1000 * g * unit**2 for g in sheet["gravity"]]
    scene.frame_start, scene.frame_end = 1, frames + 1
    modifier.point_cache.frame_start, modifier.point_cache.frame_end = 1, frames + 1


def positions(cloth):
    mesh = cloth.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    values = [0.0] * (3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", values)
    return values if all(map(math.isfinite, values)) else []


def run(sheet, frames, substeps):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    cloth = make_sheet(sheet)
    turn_ends(cloth, sheet, frames)
    if sheet["ball"]:
        add_ball(sheet["ball"])
    set_cloth(cloth, sheet, frames, substeps)
    bpy.context.scene.frame_set(1)
    start = time.perf_counter()
    for frame in range(2, frames + 2):
        bpy.context.scene.frame_set(frame)
    ms = 1e3 * (time.perf_counter() - start)
    return {"ms": ms, "positions": positions(cloth)}


def main():
    sheet_file, told_file = sys.argv[sys.argv.index("--") + 1:]
    with open(sheet_file) as text:
        sheet = json.load(text)
    told = [run(sheet, *setting) for setting in sheet["runs"]]
    with open(told_file, "w") as text:
        json.dump(told, text)


main()
