use super::*;
use endat_hdl::protocol::ModeCommand;

fn plan(x: (Quantity, &[f64]), y: (Quantity, &[f64])) -> Plan {
    let axis = |(quantity, values): (Quantity, &[f64])| Axis {
        quantity,
        values: values.to_vec(),
    };
    Plan {
        x: axis(x),
        y: axis(y),
        conditions: Conditions::new(128_000_000, ModeCommand::SendPositionAddInfo, 25),
        runs: 2,
        frames: 5,
        seed: 1,
    }
}

fn map(plan: &Plan) -> Map {
    plan.run(0, |_| {}).unwrap()
}

#[test]
fn a_sound_line_is_sampled_near_the_middle_of_the_bit() {
    let map = map(&plan(
        (Quantity::Cable, &[0.0, 30.0, 100.0]),
        (Quantity::Clock, &[2.0, 8.0, 16.0]),
    ));
    for cell in &map.cells {
        assert_eq!((cell.fate(), cell.frames()), (Fate::Good, 10));
    }
    // At most a cycle and a half of 64, 16, 8 from the middle.
    for (row, cycles) in [64.0, 16.0, 8.0].into_iter().enumerate() {
        for column in 0..3 {
            let margin = map.cell(column, row).margin().unwrap();
            assert!(
                margin > 0.5 - 1.6 / cycles && margin <= 0.5,
                "{cycles}: {margin}"
            );
        }
    }
}

#[test]
fn what_cannot_be_is_told_apart() {
    // Bits of 62.5 ns: a filter of 117 ns suppresses all; jitter of 15 ns is tolerated, 50 ns is more than half a bit.
    let mut plan = plan(
        (Quantity::Jitter, &[0.0, 15.0, 50.0]),
        (Quantity::Filter, &[0.0, 15.0]),
    );
    plan.conditions.set(Quantity::Clock, 16.0);
    let map = map(&plan);
    assert_eq!(map.cell(0, 0).fate(), Fate::Good);
    assert_eq!(map.cell(1, 0).fate(), Fate::Good);
    assert!(map.cell(1, 0).margin() < map.cell(0, 0).margin());
    assert_ne!(map.cell(2, 0).fate(), Fate::Good);
    assert_ne!(map.cell(0, 1).fate(), Fate::Good);
    assert!(map.cells.iter().all(|cell| cell.frames() == 10));
    assert_eq!(map.cell(2, 0).margin(), None);
}

#[test]
fn the_same_plan_gives_the_same_map_whatever_the_threads() {
    let plan = plan(
        (Quantity::Noise, &[0.0, 20.0, 100.0]),
        (Quantity::Distortion, &[-10.0, 10.0]),
    );
    let one = plan.run(1, |_| {}).unwrap();
    assert_eq!(one, plan.run(2, |_| {}).unwrap());
    let table = one.csv();
    assert!(is_table(&table) && !is_table("a,b,c\n1,2,3\n"));
    assert_eq!(table.lines().count(), 1 + one.cells.len());
    let columns = |line: &str| line.split(',').count();
    assert!(table
        .lines()
        .all(|l| columns(l) == columns(table.lines().next().unwrap())));
}

#[test]
fn a_value_stands_between_its_neighbours() {
    let axis = Axis {
        quantity: Quantity::Clock,
        values: vec![1.0, 2.0, 8.0, 16.0],
    };
    for (value, place) in [
        (1.0, 0.0),
        (5.0, 1.5),
        (16.0, 3.0),
        (0.5, -0.5),
        (20.0, 3.5),
    ] {
        assert_eq!(axis.place(value), place);
    }
}
