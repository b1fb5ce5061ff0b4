//! The blocks `object` and `instance`.

use std::io::{self, Write};

use super::text::{Block, number, numbers, quoted, transform};
use crate::description::{
    ByteOrder, Geometry, Instance, Mesh, Name, Object, Plane, PointSource, Tessellation, VertexData,
};

pub(super) fn object(object: &Object, out: &mut dyn Write) -> io::Result<()> {
    let block = Block::new("object");
    let block = match object.visible {
        true => {
            let block = names(block, "shader", &object.shaders);
            names(block, "modifier", &object.modifiers).option("transform", object.transform.as_ref().map(transform))
        }
        false => block.entry("noinstance", ""),
    };
    let block = block.entry("type", object.geometry.keyword());
    let block = block.option("name", object.name.as_ref().map(|name| quoted(&name.value)));
    shape(block, object, out)?.close(out)
}

pub(super) fn instance(instance: &Instance, out: &mut dyn Write) -> io::Result<()> {
    let block = Block::new("instance");
    let block = block.option("name", instance.name.as_ref().map(|name| quoted(&name.value)));
    let block = block.entry("geometry", quoted(&instance.geometry.value));
    let block = block.entry("transform", instance.transform.as_ref().map_or_else(|| "{ }".to_owned(), transform));
    let block = names(block, "shader", &instance.shaders);
    names(block, "modifier", &instance.modifiers).close(out)
}

/// `shader NAME`, or `shaders N NAME …`; nothing where there is none.
fn names(block: Block, keyword: &str, names: &[Name]) -> Block {
    match names {
        [] => block,
        [name] => block.entry(keyword, quoted(&name.value)),
        _ => {
            let list: Vec<String> = names.iter().map(|name| quoted(&name.value)).collect();
            block.entry(&format!("{keyword}s"), format!("{} {}", list.len(), list.join(" ")))
        }
    }
}

/// The keywords of the shape itself.
fn shape(mut block: Block, object: &Object, out: &mut dyn Write) -> io::Result<Block> {
    Ok(match &object.geometry {
        // Sunflow: place and size are read where there is no transform, and belong to the unit sphere elsewhere.
        Geometry::Sphere { center, radius } => {
            let is_unit = *center == [0.0; 3] && *radius == 1.0;
            match is_unit && (object.transform.is_some() || !object.visible) {
                true => block,
                false => block.entry("c", numbers(center)).entry("r", number(*radius)),
            }
        }
        Geometry::Plane(Plane::Normal { point, normal }) => {
            block.entry("p", numbers(point)).entry("n", numbers(normal))
        }
        Geometry::Plane(Plane::Points(points)) => points.iter().fold(block, |block, p| block.entry("p", numbers(p))),
        Geometry::Mesh(mesh) => return mesh_lists(block, mesh, out),
        Geometry::Box { corners: [a, b] } => block.entry("points", format!("2 {} {}", numbers(a), numbers(b))),
        Geometry::FileMesh { file, smooth_normals } => {
            block.entry("filename", quoted(&file.value)).entry("smooth_normals", smooth_normals.to_string())
        }
        Geometry::BezierMesh { net, tessellation: t } => {
            block = block.entry("n", numbers(&net.size)).entry("wrap", format!("{} {}", net.wrap[0], net.wrap[1]));
            block.rows("points", &net.points, out)?;
            tessellation(block, t)
        }
        Geometry::Teapot(t) | Geometry::Gumbo(t) => tessellation(block, t),
        Geometry::Torus { tube, ring } => block.entry("r", numbers(&[*tube, *ring])),
        Geometry::Cylinder | Geometry::Banchoff => block,
        Geometry::SphereFlake { level, axis, radius } => {
            block.entry("level", number(*level)).entry("axis", numbers(axis)).entry("radius", number(*radius))
        }
        Geometry::Julia { c, iterations, epsilon } => {
            block.entry("q", numbers(c)).entry("iterations", number(*iterations)).entry("epsilon", number(*epsilon))
        }
        Geometry::Hair(hair) => {
            block = block.entry("segments", number(hair.segments)).entry("width", number(hair.width));
            block.rows(&format!("points {}", 3 * hair.points.len()), &hair.points, out)?;
            block
        }
        Geometry::Particles { points, count, radius } => {
            match points {
                PointSource::Points(points) => block.rows(&format!("points {}", points.len()), points, out)?,
                PointSource::File { file, order } => {
                    block = block.entry("filename", quoted(&file.value));
                    if *order == ByteOrder::LittleEndian {
                        block = block.entry("little_endian", "");
                    }
                }
            }
            block.option("num", count.map(number)).entry("radius", number(*radius))
        }
    })
}

fn tessellation(block: Block, tessellation: &Tessellation) -> Block {
    block.entry("subdivs", number(tessellation.subdivs)).entry("smooth", tessellation.smooth.to_string())
}

fn mesh_lists(mut block: Block, mesh: &Mesh, out: &mut dyn Write) -> io::Result<Block> {
    block.rows(&format!("points {}", mesh.points.len()), &mesh.points, out)?;
    block.rows(&format!("triangles {}", mesh.triangles.len()), &mesh.triangles, out)?;
    vertex_data(&mut block, "normals", &mesh.normals, out)?;
    vertex_data(&mut block, "uvs", &mesh.uvs, out)?;
    if let Some(shaders) = &mesh.face_shaders {
        let (rows, rest) = shaders.as_chunks::<20>();
        block.rows("face_shaders", rows, out)?;
        block = block.option("", (!rest.is_empty()).then(|| numbers(rest)));
    }
    Ok(block)
}

fn vertex_data<const N: usize>(
    block: &mut Block,
    keyword: &str,
    data: &VertexData<[f32; N]>,
    out: &mut dyn Write,
) -> io::Result<()> {
    match data {
        VertexData::None => block.rows::<f32, N>(&format!("{keyword} none"), &[], out),
        VertexData::Vertex(rows) => block.rows(&format!("{keyword} vertex"), rows, out),
        VertexData::FaceVarying(rows) => block.rows(&format!("{keyword} facevarying"), rows, out),
    }
}
