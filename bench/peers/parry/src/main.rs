// parry3d-f64 as a peer: pairs from standard input, one answer a line (bench/peers/protocol.py).
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::ConvexPolyhedron;
use std::io::{self, BufRead, Write};
use std::panic;

fn hull<'a>(words: &mut impl Iterator<Item = &'a str>) -> Option<ConvexPolyhedron> {
    let mut count = || words.next().unwrap().parse::<usize>().unwrap();
    let (vertices, triangles) = (count(), count());
    let mut number = || words.next().unwrap().parse::<f64>().unwrap();
    let points: Vec<Vector> = (0..vertices).map(|_| Vector::new(number(), number(), number())).collect();
    let mut index = || words.next().unwrap().parse::<u32>().unwrap();
    let faces: Vec<[u32; 3]> = (0..triangles).map(|_| [index(), index(), index()]).collect();
    panic::catch_unwind(|| ConvexPolyhedron::from_convex_mesh(points.clone(), &faces))
        .ok()
        .flatten()
        .or_else(|| panic::catch_unwind(|| ConvexPolyhedron::from_convex_hull(&points)).ok().flatten())
}

fn answer(line: &str) -> String {
    let mut words = line.split_ascii_whitespace();
    let (a, b) = (hull(&mut words), hull(&mut words));
    let (Some(a), Some(b)) = (a, b) else { return "unsupported".into() };
    let here = Pose::identity();
    let ask = panic::AssertUnwindSafe(|| {
        let overlap = query::intersection_test(&here, &a, &here, &b).unwrap().intersecting;
        (overlap, query::contact(&here, &a, &here, &b, f64::MAX).unwrap())
    });
    match panic::catch_unwind(ask) {
        Err(_) => "exception".into(),
        Ok((overlap, None)) => format!("{} nan nan nan nan", overlap as u8),
        Ok((overlap, Some(c))) => format!("{} {:e} {:e} {:e} {:e}", overlap as u8, c.dist, c.normal1.x, c.normal1.y, c.normal1.z),
    }
}

fn main() {
    panic::set_hook(Box::new(|_| {}));
    let mut out = io::stdout();
    for line in io::stdin().lock().lines() {
        writeln!(out, "{}", answer(&line.unwrap())).unwrap();
        out.flush().unwrap();
    }
}
