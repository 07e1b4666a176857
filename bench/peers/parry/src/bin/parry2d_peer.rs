// parry2d-f64 on pairs of convex polygons. The first line has the polygons, each its number of corners and their
// coordinates; pair i is polygons 2 i and 2 i + 1. Each further line is a query, "overlap", "depth" or "distance".
// The answer to it is a line with the CPU time in ns and the figures of all pairs.
use parry2d_f64::math::{Pose, Vector};
use parry2d_f64::query;
use parry2d_f64::shape::ConvexPolygon;
use std::hint::black_box;
use std::io::{self, BufRead, Write};
use std::panic;

#[repr(C)]
struct Time {
    seconds: i64,
    nanoseconds: i64,
}
extern "C" {
    fn clock_gettime(clock: i32, time: *mut Time) -> i32;
}

fn cpu_time() -> i64 {
    const PROCESS: i32 = 2;
    let mut time = Time { seconds: 0, nanoseconds: 0 };
    unsafe { clock_gettime(PROCESS, &mut time) };
    time.seconds * 1_000_000_000 + time.nanoseconds
}

fn polygons(line: &str) -> Vec<ConvexPolygon> {
    let mut words = line.split_ascii_whitespace();
    let mut made = Vec::new();
    while let Some(count) = words.next() {
        let mut number = || words.next().unwrap().parse::<f64>().unwrap();
        let corners = (0..count.parse().unwrap()).map(|_| Vector::new(number(), number())).collect();
        made.push(ConvexPolygon::from_convex_polyline_unmodified(corners).unwrap());
    }
    made
}

fn figure(query: &str, a: &ConvexPolygon, b: &ConvexPolygon) -> f64 {
    let here = Pose::identity();
    let ask = panic::AssertUnwindSafe(|| match query {
        "overlap" => query::intersection_test(&here, a, &here, b).unwrap().intersecting as u8 as f64,
        "depth" => query::contact(&here, a, &here, b, 0.0).unwrap().map_or(0.0, |c| -c.dist),
        _ => query::distance(&here, a, &here, b).unwrap().distance,
    });
    panic::catch_unwind(ask).unwrap_or(f64::NAN)
}

fn main() {
    panic::set_hook(Box::new(|_| {}));
    let mut lines = io::stdin().lock().lines();
    let polygons = polygons(&lines.next().unwrap().unwrap());
    let mut out = io::stdout();
    for line in lines {
        let query = line.unwrap();
        let mut figures = Vec::with_capacity(polygons.len() / 2);
        let start = cpu_time();
        for pair in polygons.chunks(2) {
            figures.push(black_box(figure(&query, &pair[0], &pair[1])));
        }
        write!(out, "{}", cpu_time() - start).unwrap();
        for figure in figures {
            write!(out, " {figure:e}").unwrap();
        }
        writeln!(out).unwrap();
        out.flush().unwrap();
    }
}
