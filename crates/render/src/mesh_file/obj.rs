//! Wavefront OBJ: points, texture coordinates and faces; everything else is passed over.

use glam::{Vec2, Vec3};

use crate::geometry::{MeshShape, PerVertex};

/// Reads `v`, `vt` and `f`. Faces with more than three corners become fans; corners are counted from 1, or backwards from −1.
pub(super) fn read(bytes: &[u8]) -> Result<MeshShape, String> {
    let mut mesh = MeshShape::default();
    let (mut texture_points, mut uvs) = (Vec::new(), Vec::new());
    let mut face: Vec<[u32; 2]> = Vec::new();
    for (number, line) in bytes.split(|byte| *byte == b'\n').enumerate() {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let read = match words.next() {
            Some(b"v") => floats(words).map(|[x, y, z]| mesh.points.push(Vec3::new(x, y, z))),
            Some(b"vt") => floats(words).map(|[u, v]| texture_points.push(Vec2::new(u, v))),
            Some(b"f") => {
                face.clear();
                let counts = [mesh.points.len(), texture_points.len()];
                words.try_for_each(|word| {
                    face.push(corner(word, counts)?);
                    Some(())
                })
            }
            _ => continue,
        };
        if read.is_none() {
            return Err(format!("line {} cannot be read", number + 1));
        }
        for k in 2..face.len() {
            let fan = [face[0], face[k - 1], face[k]];
            mesh.triangles.push(fan.map(|[point, _]| point));
            uvs.extend(fan.map(|[_, uv]| texture_points.get(uv as usize).copied().unwrap_or_default()));
        }
        face.clear();
    }
    if !texture_points.is_empty() {
        mesh.uvs = PerVertex::Corner(uvs);
    }
    Ok(mesh)
}

/// The first `N` words as numbers.
fn floats<'a, const N: usize>(mut words: impl Iterator<Item = &'a [u8]>) -> Option<[f32; N]> {
    let mut values = [0.0; N];
    for value in &mut values {
        *value = std::str::from_utf8(words.next()?).ok()?.parse().ok()?;
    }
    Some(values)
}

/// `point`, `point/uv`, `point//normal` or `point/uv/normal`, as indices from 0; without texture coordinates, no index.
fn corner(word: &[u8], counts: [usize; 2]) -> Option<[u32; 2]> {
    let mut parts = word.split(|byte| *byte == b'/');
    let point = index(parts.next()?, counts[0])?;
    let uv = match parts.next() {
        None | Some(b"") => u32::MAX,
        Some(part) => index(part, counts[1])?,
    };
    Some([point, uv])
}

/// An index from 1, or backwards from −1, as one from 0.
fn index(part: &[u8], count: usize) -> Option<u32> {
    let written: i64 = std::str::from_utf8(part).ok()?.parse().ok()?;
    let index = if written < 0 { count as i64 + written } else { written - 1 };
    u32::try_from(index).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_of_every_form_are_read() {
        let text = b"# a comment \xff\no cube\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\r\nvt 0 0\nvt 1 0\nvn 0 0 1\n\
                     f 1 2 3\nf 1/1 2/2 3/1\nf 1//1 2//1 3//1\nf -4 -3 -2 -1\ns off\n";
        let mesh = read(text).expect("it is one");
        assert_eq!(mesh.points.len(), 4);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 1, 2], [0, 1, 2], [0, 1, 2], [0, 2, 3]]);
        let PerVertex::Corner(uvs) = &mesh.uvs else { panic!("uvs") };
        assert_eq!((uvs.len(), uvs[4]), (15, Vec2::X));
    }

    #[test]
    fn mistakes_have_a_line() {
        assert_eq!(read(b"v 0 0 0\nv 0 0\n").unwrap_err(), "line 2 cannot be read");
        assert_eq!(read(b"f 1 x 3\n").unwrap_err(), "line 1 cannot be read");
        assert_eq!(read(b"v 0 0 0\nf 0 1 1\n").unwrap_err(), "line 2 cannot be read");
    }
}
