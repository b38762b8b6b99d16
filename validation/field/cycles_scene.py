"""Renders OBJ scenes of exactff with Cycles so that each pixel estimates the pixel of `exactff render`.

Usage: blender --background --factory-startup --python-exit-code 1 --python cycles_scene.py

Reads jobs from standard input, one JSON object a line. A job states, with the names of exactff's flags: scene, eye,
look, up, fov, size, threads, and output (an EXR file); and
  samples, seed
  lamp       "mesh": the emitting faces, as in the file; "area": each emitting rectangle as an area lamp of Blender
  scale      multiplies all coordinates, also the camera's
  user       true: Blender's defaults wherever the scene does not need another value
and whatever an experiment sets differently: the keys of DEFAULTS.
After each job, prints a line `timing SECONDS PROCESSOR-SECONDS`: the render, with Cycles' own preparations.
"""

import json
import math
import pathlib
import resource
import sys
import time

import bpy
from mathutils import Matrix, Vector

DEFAULTS = {"lamp": "mesh", "scale": 1, "user": False, "pattern": "SOBOL", "filter_type": "BLACKMAN_HARRIS",
            "filter_width": 0.01, "sample_as_light": True, "bounces": 0}


def read_materials(path):
    materials = {}
    for words in map(str.split, path.read_text(encoding="utf-8").splitlines()):
        if words[:1] == ["newmtl"]:
            materials[words[1]] = {"Kd": (0.0, 0.0, 0.0), "Ke": (0.0, 0.0, 0.0)}
            current = materials[words[1]]
        elif words[:1] in (["Kd"], ["Ke"]):
            current[words[0]] = tuple(map(float, words[1:4]))
    return materials


# Blender's own importer turns the axes and may merge or smooth; a scene of ours needs none of that. Returns vertices,
# and (material, corners) of each face.
def read_scene(path):
    vertices, faces, materials, material = [], [], {}, None
    for words in map(str.split, path.read_text(encoding="utf-8").splitlines()):
        if words[:1] == ["v"]:
            vertices.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["mtllib"]:
            materials = read_materials(path.parent / words[1])
        elif words[:1] == ["usemtl"]:
            material = words[1]
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) for word in words[1:]]
            faces.append((material, [corner - 1 if corner > 0 else len(vertices) + corner for corner in corners]))
    return vertices, faces, materials


# Ke is a radiosity: the radiance is Ke / pi. A diffuse node of roughness 0 is Lambert's law.
def shader(name, colours, sample_as_light):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    emits = any(colours["Ke"])
    material.cycles.sample_as_light = sample_as_light
    node = nodes.new("ShaderNodeEmission" if emits else "ShaderNodeBsdfDiffuse")
    node.inputs["Color"].default_value = (*([one / math.pi for one in colours["Ke"]] if emits else colours["Kd"]), 1)
    if emits:
        node.inputs["Strength"].default_value = 1
    else:
        node.inputs["Roughness"].default_value = 0
    output = nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material


def add_faces(vertices, faces, materials, sample_as_light):
    mesh = bpy.data.meshes.new("scene")
    mesh.from_pydata(vertices, [], [corners for _, corners in faces])
    names = sorted({material for material, _ in faces})
    for name in names:
        mesh.materials.append(shader(name, materials[name], sample_as_light))
    for polygon, (material, _) in zip(mesh.polygons, faces):
        polygon.material_index = names.index(material)
        polygon.use_smooth = False  # normals of the faces, so that no shadow terminator is moved
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("scene", mesh))


# An area lamp shines along its -z. Its radiance is power / (4 area).
def add_area_lamp(corners, radiosity):
    a, b, c, d = map(Vector, corners)
    if (b - a + d - c).length > 1e-4 * (c - a).length or abs((b - a).dot(d - a)) > 1e-4 * (c - a).length_squared:
        sys.exit("Only rectangles can be area lamps; use lamp = mesh.")
    lamp = bpy.data.lights.new("lamp", "AREA")
    lamp.shape = "RECTANGLE"
    lamp.size, lamp.size_y = (b - a).length, (d - a).length
    lamp.energy = 4 * lamp.size * lamp.size_y
    lamp.color = [one / math.pi for one in radiosity]
    across, front = (b - a).normalized(), (b - a).cross(d - a).normalized()
    thing = bpy.data.objects.new("lamp", lamp)
    thing.matrix_world = axes(across, (-front).cross(across), -front, (a + c) / 2)
    bpy.context.scene.collection.objects.link(thing)


def axes(x, y, z, origin):
    return Matrix(((x[0], y[0], z[0], origin[0]), (x[1], y[1], z[1], origin[1]), (x[2], y[2], z[2], origin[2]),
                   (0, 0, 0, 1)))


# Blender's camera looks along its -z with y upwards; pixel centres and the order of rows are the same as ours.
def add_camera(job):
    eye, forward = Vector(job["eye"]) * job["scale"], (Vector(job["look"]) - Vector(job["eye"])).normalized()
    right = forward.cross(Vector(job["up"])).normalized()
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = math.radians(job["fov"])
    camera.clip_start, camera.clip_end = 1e-3, 1e6
    thing = bpy.data.objects.new("camera", camera)
    thing.matrix_world = axes(right, right.cross(forward), -forward, eye)
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.scene.camera = thing


# What any comparison needs, also that of somebody who knows no setting of Cycles.
def needed_settings(job):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.render.threads_mode, scene.render.threads = "FIXED", job["threads"]
    scene.render.resolution_x, scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"  # linear, whatever the view transform is
    scene.render.image_settings.color_depth = "32"  # the default of 16 bits rounds to 5e-4
    scene.render.filepath = job["output"]
    scene.cycles.samples = job["samples"]
    scene.cycles.seed = job["seed"]
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = job["bounces"]  # 0: direct light only
    scene.cycles.use_denoising = False  # the default, which would blur penumbrae; Debian's build cannot denoise
    scene.world.use_nodes = False
    scene.world.color = (0, 0, 0)  # the default world is grey and would add light


# What makes each pixel an unbiased estimate of ours, at the same point.
def fair_settings(job):
    return {
        "use_adaptive_sampling": False,  # would stop where the noise seems low, which biases
        "light_sampling_threshold": 0,  # would drop weak light at random
        "sample_clamp_direct": 0,  # would darken bright samples
        "sample_clamp_indirect": 0,
        "sampling_pattern": job["pattern"],
        "pixel_filter_type": job["filter_type"],
        "filter_width": job["filter_width"],  # in pixels; 0.01 is the least that Blender allows
    }


def add_scene(job):
    vertices, faces, materials = read_scene(pathlib.Path(job["scene"]))
    vertices = [tuple(job["scale"] * one for one in vertex) for vertex in vertices]
    if job["lamp"] == "area":
        for material, corners in faces:
            if any(materials[material]["Ke"]):
                add_area_lamp([vertices[corner] for corner in corners], materials[material]["Ke"])
        faces = [face for face in faces if not any(materials[face[0]]["Ke"])]
    add_faces(vertices, faces, materials, job["sample_as_light"])


def render(job):
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    add_scene(job)
    add_camera(job)
    needed_settings(job)
    cycles = bpy.context.scene.cycles
    for name, value in fair_settings(job).items():
        if job["user"]:
            cycles.property_unset(name)
        else:
            setattr(cycles, name, value)
    clock, used = time.perf_counter(), resource.getrusage(resource.RUSAGE_SELF)
    bpy.ops.render.render(write_still=True)
    now = resource.getrusage(resource.RUSAGE_SELF)
    used = now.ru_utime + now.ru_stime - used.ru_utime - used.ru_stime
    print("timing", time.perf_counter() - clock, used, flush=True)


for line in sys.stdin:
    render({**DEFAULTS, **json.loads(line)})
