//! STL: triangles without shared points, in the binary form or as text.

use glam::Vec3;

use super::four;
use crate::geometry::MeshShape;

/// The binary form: a header, the number of triangles, then 50 bytes for each.
const HEADER: usize = 84;
const RECORD: usize = 50;

pub(super) fn read(bytes: &[u8]) -> Result<MeshShape, String> {
    let announced = four(bytes, HEADER - 4).map(|count| u32::from_le_bytes(count) as usize);
    let fits =
        announced.is_some_and(|count| count.checked_mul(RECORD).is_some_and(|size| size <= bytes.len() - HEADER));
    // Some binary files begin like a text: their size decides.
    if bytes.trim_ascii_start().starts_with(b"solid") && !(fits && announced.is_some_and(|count| count > 0)) {
        return text(bytes);
    }
    match announced {
        Some(count) if fits => Ok(binary(&bytes[HEADER..], count)),
        _ => Err("it ends too soon".to_owned()),
    }
}

fn binary(bytes: &[u8], count: usize) -> MeshShape {
    let (mut mesh, float) =
        (with_room_for(count), |bytes: &[u8], at| f32::from_le_bytes(four(bytes, at).unwrap_or_default()));
    for record in bytes.chunks_exact(RECORD).take(count) {
        // The normal comes first; the corners say the same.
        let corner = |k: usize| Vec3::from_array(std::array::from_fn(|axis| float(record, 12 * (k + 1) + 4 * axis)));
        push(&mut mesh, [0, 1, 2].map(corner));
    }
    mesh
}

fn text(bytes: &[u8]) -> Result<MeshShape, String> {
    let mut words = bytes.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    let (mut mesh, mut corners) = (MeshShape::default(), Vec::new());
    while let Some(word) = words.next() {
        if word != b"vertex" {
            continue;
        }
        let mut point = [0.0; 3];
        for coordinate in &mut point {
            let number = words.next().and_then(|word| std::str::from_utf8(word).ok()?.parse().ok());
            *coordinate = number.ok_or("a `vertex` lacks its three numbers")?;
        }
        corners.push(Vec3::from(point));
        if let [a, b, c] = corners[..] {
            push(&mut mesh, [a, b, c]);
            corners.clear();
        }
    }
    match (mesh.triangles.is_empty(), corners.is_empty()) {
        (_, false) => Err("its last triangle lacks a corner".to_owned()),
        (true, _) => Err("it has no triangles".to_owned()),
        _ => Ok(mesh),
    }
}

fn with_room_for(triangles: usize) -> MeshShape {
    MeshShape {
        points: Vec::with_capacity(3 * triangles),
        triangles: Vec::with_capacity(triangles),
        ..MeshShape::default()
    }
}

fn push(mesh: &mut MeshShape, corners: [Vec3; 3]) {
    let first = mesh.points.len() as u32;
    mesh.points.extend(corners);
    mesh.triangles.push([first, first + 1, first + 2]);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one_triangle() -> Vec<u8> {
        let mut bytes = vec![0; HEADER];
        bytes[80] = 1;
        for number in [0.0f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend([0, 0]);
        bytes
    }

    #[test]
    fn both_forms_are_read() {
        let expected = [Vec3::ZERO, Vec3::X, Vec3::Y * 2.0];
        let mut bytes = one_triangle();
        assert_eq!(read(&bytes).expect("binary").points, expected);
        bytes[..6].copy_from_slice(b"solid ");
        assert_eq!(read(&bytes).expect("binary that begins like a text").points, expected);
        let text = "solid a\nfacet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 0 2e0 0\n endloop\nendfacet\nendsolid a\n";
        let mesh = read(text.as_bytes()).expect("text");
        assert_eq!((mesh.points.as_slice(), mesh.triangles.as_slice()), (&expected[..], &[[0, 1, 2]][..]));
    }

    #[test]
    fn a_file_that_ends_too_soon_is_refused() {
        let bytes = one_triangle();
        assert!(read(&bytes[..bytes.len() - 1]).is_err());
        assert!(read(b"solid a vertex 0 0 0 vertex 1 0").is_err());
        assert!(read(b"solid a vertex 0 0 0 vertex 1 0 0").is_err());
        let mut huge = one_triangle();
        huge[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(read(&huge).is_err());
    }
}
