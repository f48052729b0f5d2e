//! Ranking of the snakes in a race.

use super::lane::Lane;

/// State of a lane that determines its rank.
#[derive(Debug, Clone, PartialEq)]
pub struct RankedLane {
    /// Number of the lane; the first is 0.
    pub lane: usize,
    /// Label of the lane.
    pub name: String,
    /// Time of landing, in simulated seconds; `None` if the snake has not landed.
    pub landed_s: Option<f64>,
    /// Whether the snake is disqualified.
    pub is_disqualified: bool,
    /// Whether the mouse has pulled the snake, which removes it from the ranking.
    pub is_disturbed: bool,
    /// Distance of the middle block along y, in metres.
    pub y_m: f32,
}

/// Returns the lanes in ranking order: landed lanes by time, then others by distance, then pulled and disqualified ones.
pub fn ranking<'a>(lanes: impl IntoIterator<Item = &'a Lane>, time_s: f64) -> Vec<RankedLane> {
    let mut ranking: Vec<RankedLane> = lanes
        .into_iter()
        .map(|lane| {
            let evaluation = lane.evaluation();
            RankedLane {
                lane: lane.number,
                name: lane.staged.label().to_owned(),
                landed_s: lane.landed_s(time_s),
                is_disqualified: evaluation.disqualified.is_some(),
                is_disturbed: lane.replay.is_disturbed(),
                y_m: evaluation.centre_y_m,
            }
        })
        .collect();
    order(&mut ranking);
    ranking
}

fn order(ranking: &mut [RankedLane]) {
    ranking.sort_by(|a, b| {
        let landed = |ranked: &RankedLane| ranked.landed_s.unwrap_or(f64::INFINITY);
        let by_place = b.y_m.total_cmp(&a.y_m).then(a.lane.cmp(&b.lane));
        let counts = |ranked: &RankedLane| (ranked.is_disqualified, ranked.is_disturbed);
        counts(a).cmp(&counts(b)).then(landed(a).total_cmp(&landed(b))).then(by_place)
    });
}

impl RankedLane {
    /// Returns whether the lane's result counts in the ranking.
    pub fn counts(&self) -> bool {
        !self.is_disqualified && !self.is_disturbed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ranking_puts_landed_lanes_first_and_pulled_or_disqualified_ones_last() {
        let ranked = |lane, landed_s, is_disqualified, y_m| RankedLane {
            lane,
            name: lane.to_string(),
            landed_s,
            is_disqualified,
            is_disturbed: lane == 5,
            y_m,
        };
        let mut ranking = [
            ranked(0, None, false, 12.0),
            ranked(1, Some(9.0), false, 24.0),
            ranked(2, None, true, 30.0),
            ranked(3, Some(7.5), false, 22.0),
            ranked(4, None, false, 14.0),
            ranked(5, None, false, 40.0),
        ];
        order(&mut ranking);
        let lanes = ranking.map(|ranked| ranked.lane);
        assert_eq!(lanes, [3, 1, 4, 0, 5, 2]);
    }
}
