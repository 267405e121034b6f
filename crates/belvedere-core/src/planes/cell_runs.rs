//! Runs of cells in rows, and the rectangles that they make.

/// Runs of the cells of a row that count.
pub(super) struct RowRuns {
    pub(super) row: usize,
    /// First cell of each run, and the one after its last.
    pub(super) runs: Vec<[usize; 2]>,
}

impl RowRuns {
    /// The runs of columns in ascending order.
    pub(super) fn new(row: usize, columns: impl Iterator<Item = usize>) -> Self {
        let mut runs: Vec<[usize; 2]> = Vec::new();
        for column in columns {
            match runs.last_mut() {
                Some(run) if run[1] == column => run[1] = column + 1,
                _ => runs.push([column, column + 1]),
            }
        }
        Self { row, runs }
    }

    /// Number of cells that count.
    pub(super) fn cell_count(&self) -> usize {
        self.runs.iter().map(|run| run[1] - run[0]).sum()
    }
}

/// Runs of cells in rows as rectangles, first and last corner in cells. Runs above each other whose ends differ by a
/// cell at most are one, as narrow as the narrowest.
pub(super) fn rectangles(rows: Vec<RowRuns>) -> Vec<[[usize; 2]; 2]> {
    let mut done = Vec::new();
    // the rectangle so far, and its first ends
    let mut open: Vec<([[usize; 2]; 2], [usize; 2])> = Vec::new();
    for RowRuns { row, runs } in rows {
        let mut next = Vec::new();
        for run in runs {
            let goes_on = |(rectangle, first): &([[usize; 2]; 2], [usize; 2])| {
                rectangle[1][1] == row && (0..2).all(|end| first[end].abs_diff(run[end]) <= 1)
            };
            match open.iter().position(goes_on) {
                Some(place) => {
                    let ([low, high], first) = open.swap_remove(place);
                    let rectangle = [[low[0].max(run[0]), low[1]], [high[0].min(run[1]), row + 1]];
                    next.push((rectangle, first));
                }
                None => next.push(([[run[0], row], [run[1], row + 1]], run)),
            }
        }
        done.extend(open.drain(..).map(|(rectangle, _)| rectangle));
        open = next;
    }
    done.extend(open.into_iter().map(|(rectangle, _)| rectangle));
    done.retain(|[low, high]| low[0] < high[0]);
    done.sort_unstable();
    done
}
