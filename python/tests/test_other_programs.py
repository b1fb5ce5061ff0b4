"""Baked sets in other programs, where their Python modules are installed beside this package: Blender (bpy) and MaterialX."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jaspe

SIZE = 128


@pytest.mark.parametrize(("name", "normal", "frames"), [("fire", "gl", None), ("stone", "dx", None), ("water", "gl", 3)])
def test_blender_finds_the_maps(name: str, normal: Any, frames: Any, tmp_path: Path) -> None:
    bpy: Any = pytest.importorskip("bpy")
    jaspe.Texture(name).bake_set(tmp_path / "set", SIZE, normal=normal, frames=frames)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(tmp_path / "set" / f"{name}.gltf"))
    (thing,) = (thing for thing in bpy.data.objects if thing.type == "MESH")
    materials = list(bpy.data.materials)
    assert len(materials) == (frames or 1) and thing.active_material is not None
    for material in materials:
        (shader,) = (node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")

        def source(socket: str, shader: Any = shader) -> Any:
            """The picture behind an input."""
            node = shader.inputs[socket].links[0].from_node
            while node.type != "TEX_IMAGE":
                node = next(link.from_node for inlet in node.inputs for link in inlet.links)
            return node.image

        expected = {"Base Color": "color", "Roughness": "roughness", "Normal": "normal.gl" if normal == "dx" else "normal"}
        if name == "fire":
            expected["Emission Color"] = "emission"
        for socket, stem in expected.items():
            image = source(socket)
            assert Path(image.filepath).name.startswith(stem + "."), socket
            assert tuple(image.size) == (SIZE, SIZE)
            space = "sRGB" if "Color" in socket else "Non-Color"
            assert image.colorspace_settings.name == space, socket
    # Relief is seen from the right side: the normals of glTF lean against the slope of the height.
    normals = np.array(source("Normal").pixels).reshape(SIZE, SIZE, 4)
    if frames is None:
        heights = jaspe.Texture(name).bake(SIZE, ["height"])["height"][::-1]
        slope = np.roll(heights, -1, 0) - np.roll(heights, 1, 0)
        assert np.corrcoef(slope.ravel(), normals[..., 1].ravel())[0, 1] < -0.5


@pytest.mark.parametrize("normal", ["gl", "dx"])
def test_materialx_makes_a_shader(normal: Any, tmp_path: Path) -> None:
    # In a process of its own: the two modules do not like each other's libraries everywhere.
    pytest.importorskip("MaterialX")
    jaspe.Texture("fire").bake_set(tmp_path / "set", SIZE, normal=normal)
    program = """
import sys
import MaterialX as mx
import MaterialX.PyMaterialXGenGlsl as glsl
import MaterialX.PyMaterialXGenShader as shaders

document, library = mx.createDocument(), mx.createDocument()
mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
mx.readFromXmlFile(document, sys.argv[1])
document.importLibrary(library)
valid, message = document.validate()
assert valid, message
generator = glsl.GlslShaderGenerator.create()
context = shaders.GenContext(generator)
context.registerSourceCodeSearchPath(mx.getDefaultDataSearchPath())
(material,) = shaders.findRenderableElements(document)
code = generator.generate(material.getName(), material, context).getSourceCode("pixel")
for uniform in ("color_file", "normal_file", "roughness_file", "emission_file"):
    assert uniform in code, uniform
"""
    words = [sys.executable, "-c", program, str(tmp_path / "set" / "fire.mtlx")]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
