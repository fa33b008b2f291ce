//! Places labels beside points so that nothing covers anything.

use super::palette::MARKER;
use super::svg::{TEXT, width};

/// An axis-aligned rectangle on the drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Left.
    pub x: f64,
    /// Top.
    pub y: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

impl Rect {
    /// Whether the inner parts of the two meet.
    pub fn meets(&self, other: &Self) -> bool {
        self.x < other.x + other.width
            && other.x < self.x + self.width
            && self.y < other.y + other.height
            && other.y < self.y + self.height
    }

    /// Whether `other` lies within.
    pub fn holds(&self, other: &Self) -> bool {
        self.x <= other.x
            && self.y <= other.y
            && other.x + other.width <= self.x + self.width
            && other.y + other.height <= self.y + self.height
    }

    fn nearest(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (x.clamp(self.x, self.x + self.width), y.clamp(self.y, self.y + self.height))
    }
}

/// Where a label went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Label {
    /// The text's left end and base line.
    pub at: (f64, f64),
    /// The room it takes.
    pub room: Rect,
    /// The end of a line from the point to the label, where they are apart.
    pub leader: Option<(f64, f64)>,
}

/// Height of a label's room.
const HEIGHT: f64 = TEXT + 2.0;
/// The base line lies this far above the room's lower edge.
const DESCENT: f64 = 3.5;
/// A label farther from its point than this gets a line to it.
const NEAR: f64 = MARKER + 6.0;

/// The rectangle that a point's marker takes.
fn marker((x, y): (f64, f64)) -> Rect {
    let r = MARKER * 1.3;
    Rect { x: x - r, y: y - r, width: 2.0 * r, height: 2.0 * r }
}

/// The rectangle that a horizontal or vertical line takes.
pub fn line((x1, y1): (f64, f64), (x2, y2): (f64, f64)) -> Rect {
    const WIDTH: f64 = 2.0;
    let (x, y) = (x1.min(x2) - WIDTH / 2.0, y1.min(y2) - WIDTH / 2.0);
    Rect { x, y, width: (x2 - x1).abs() + WIDTH, height: (y2 - y1).abs() + WIDTH }
}

/// A place within `area` for each point's text, that of the first points first. No label covers
/// another one, a marker or one of the `obstacles`; `None` is a label without room.
pub fn place(
    points: &[(f64, f64)],
    texts: &[&str],
    area: Rect,
    obstacles: impl IntoIterator<Item = Rect>,
) -> Vec<Option<Label>> {
    let mut taken: Vec<Rect> = points.iter().map(|point| marker(*point)).chain(obstacles).collect();
    let mut labels = Vec::new();
    for (point, text) in points.iter().zip(texts) {
        let size = (width(text), HEIGHT);
        let free = |room: &Rect| area.holds(room) && taken.iter().all(|other| !other.meets(room));
        let room = around(*point, size).find(free).or_else(|| anywhere(*point, size, area, free));
        labels.push(room.map(|room| label(*point, room)));
        taken.extend(room);
    }
    labels
}

/// Rooms beside the point, the better ones first.
fn around((x, y): (f64, f64), (w, h): (f64, f64)) -> impl Iterator<Item = Rect> {
    let gap = MARKER + 3.0;
    let sides = [
        (gap, -h / 2.0),
        (-gap - w, -h / 2.0),
        (-w / 2.0, -gap - h),
        (-w / 2.0, gap),
        (gap * 0.7, -gap * 0.7 - h),
        (gap * 0.7, gap * 0.7),
        (-gap * 0.7 - w, -gap * 0.7 - h),
        (-gap * 0.7 - w, gap * 0.7),
    ];
    sides.into_iter().map(move |(dx, dy)| Rect { x: x + dx, y: y + dy, width: w, height: h })
}

/// The free room nearest to the point.
fn anywhere(
    point: (f64, f64),
    (width, height): (f64, f64),
    area: Rect,
    free: impl Fn(&Rect) -> bool,
) -> Option<Rect> {
    const STEP: f64 = 3.0;
    let steps = |extent: f64| 0..=(extent.max(0.0) / STEP) as usize;
    let rooms = steps(area.height - height).flat_map(|row| {
        steps(area.width - width).map(move |col| Rect {
            x: area.x + col as f64 * STEP,
            y: area.y + row as f64 * STEP,
            width,
            height,
        })
    });
    rooms.filter(free).min_by(|a, b| distance(point, a).total_cmp(&distance(point, b)))
}

fn distance(point: (f64, f64), room: &Rect) -> f64 {
    let (x, y) = room.nearest(point);
    (x - point.0).hypot(y - point.1)
}

fn label(point: (f64, f64), room: Rect) -> Label {
    let leader = (distance(point, &room) > NEAR).then(|| room.nearest(point));
    Label { at: (room.x, room.y + room.height - DESCENT), room, leader }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const AREA: Rect = Rect { x: 50.0, y: 10.0, width: 300.0, height: 240.0 };
    const NAMES: [&str; 12] = [
        "bmssm",
        "bmssm-dense",
        "ssm",
        "ssm-list",
        "obvhs-bvh2",
        "obvhs-cwbvh",
        "embree",
        "embree-robust",
        "embree-compact",
        "embree-packet",
        "minmax",
        "sphere",
    ];

    fn sound(points: &[(f64, f64)]) -> Result<(), TestCaseError> {
        let labels = place(points, &NAMES[..points.len()], AREA, []);
        let rooms: Vec<Rect> = labels.iter().map(|label| label.expect("room for all").room).collect();
        for (i, room) in rooms.iter().enumerate() {
            prop_assert!(AREA.holds(room));
            prop_assert!(rooms[..i].iter().all(|other| !other.meets(room)), "label over label");
            prop_assert!(points.iter().all(|point| !marker(*point).meets(room)), "label over marker");
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn labels_cover_nothing(points in prop::collection::vec((50.0..350.0f64, 10.0..250.0f64), 0..12)) {
            sound(&points)?;
        }

        #[test]
        fn nor_in_a_crowd(points in prop::collection::vec((340.0..350.0f64, 10.0..25.0f64), 0..12)) {
            sound(&points)?;
        }
    }

    #[test]
    fn a_lonely_label_is_beside_its_point_and_a_crowded_one_has_a_line() {
        let [Some(label)] = place(&[(100.0, 100.0)], &["x"], AREA, [])[..] else { panic!() };
        assert_eq!(label.leader, None);
        assert!(label.room.x > 100.0);
        let crowd = place(&[(200.0, 100.0); 12], &NAMES, AREA, []);
        assert!(crowd.iter().flatten().any(|label| label.leader.is_some()));
    }

    #[test]
    fn lines_are_kept_clear_of() {
        let [Some(label)] =
            place(&[(100.0, 100.0)], &["x"], AREA, [line((100.0, 100.0), (200.0, 100.0))])[..]
        else {
            panic!()
        };
        assert!(label.room.x + label.room.width < 100.0, "to the left, for the line leaves to the right");
    }

    #[test]
    fn no_room_is_said() {
        let tiny = Rect { x: 0.0, y: 0.0, width: 5.0, height: 5.0 };
        assert_eq!(place(&[(2.0, 2.0)], &["long name"], tiny, []), [None]);
    }
}
