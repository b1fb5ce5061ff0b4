//! RA3: the numbers of points and triangles, then both lists, everything little-endian and four bytes wide.

use glam::Vec3;

use super::four;
use crate::geometry::MeshShape;

pub(super) fn read(bytes: &[u8]) -> Result<MeshShape, String> {
    let count = |at: usize| four(bytes, at).map(|count| u32::from_le_bytes(count) as usize);
    let (Some(points), Some(triangles)) = (count(0), count(4)) else { return Err("it ends too soon".to_owned()) };
    let needed = points.checked_add(triangles).and_then(|sum| sum.checked_mul(12));
    if needed.is_none_or(|needed| needed > bytes.len() - 8) {
        return Err(format!("it announces {points} points and {triangles} triangles, and is too short for them"));
    }
    let (points, triangles) = bytes[8..8 + 12 * (points + triangles)].split_at(12 * points);
    let three = |bytes: &[u8]| [0, 4, 8].map(|at| four(bytes, at).unwrap_or_default());
    Ok(MeshShape {
        points: points.chunks_exact(12).map(|p| Vec3::from(three(p).map(f32::from_le_bytes))).collect(),
        triangles: triangles.chunks_exact(12).map(|t| three(t).map(u32::from_le_bytes)).collect(),
        ..MeshShape::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_and_triangles_are_read() {
        let mut bytes: Vec<u8> = [3u32, 1].iter().flat_map(|n| n.to_le_bytes()).collect();
        bytes.extend([0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.5].iter().flat_map(|n| n.to_le_bytes()));
        bytes.extend([0u32, 1, 2].iter().flat_map(|n| n.to_le_bytes()));
        let mesh = read(&bytes).expect("it is one");
        assert_eq!(mesh.points, [Vec3::ZERO, Vec3::X, Vec3::new(0.0, 1.0, 0.5)]);
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
        assert!(read(&bytes[..bytes.len() - 1]).is_err());
        assert!(read(&[0xff; 16]).is_err());
    }
}
