//! Triangles that have the same three vertices.

/// What was found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Twice {
    /// Triangles that have the vertices of an earlier one, in whatever order.
    pub(super) count: usize,
    /// The first of them.
    pub(super) first: usize,
}

/// Finds triangles that have the same three vertices, by index. Sorts them by their lowest vertex, then looks at those
/// that share it.
pub(super) fn find(corners: &[u32]) -> Twice {
    let triangles = corners.as_chunks::<3>().0;
    let lowest = |t: &[u32; 3]| t[0].min(t[1]).min(t[2]) as usize;
    let count = corners.iter().max().map_or(0, |&last| last as usize + 1);
    // Where the triangles of each lowest vertex end; counted down to where they start while they are placed.
    let mut starts = vec![0u32; count + 1];
    for triangle in triangles {
        starts[lowest(triangle)] += 1;
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    let mut order = vec![0u32; triangles.len()];
    for (i, triangle) in triangles.iter().enumerate() {
        let start = &mut starts[lowest(triangle)];
        *start -= 1;
        order[*start as usize] = i as u32;
    }
    let mut found = Twice {
        count: 0,
        first: usize::MAX,
    };
    let mut same = Vec::new();
    for range in starts.windows(2) {
        let group = &order[range[0] as usize..range[1] as usize];
        if group.len() < 2 {
            continue;
        }
        same.clear();
        same.extend(group.iter().map(|&t| {
            let mut key = triangles[t as usize];
            key.sort_unstable();
            (key, t as usize)
        }));
        same.sort_unstable();
        for pair in same.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            found.count += 1;
            found.first = found.first.min(pair[1].1);
        }
    }
    if found.count > 0 {
        found
    } else {
        Twice::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn either_winding_and_any_first_corner_is_the_same() {
        let twice = |corners: &[u32]| find(corners);
        assert_eq!(twice(&[]), Twice::default());
        assert_eq!(twice(&[0, 1, 2, 0, 1, 3, 1, 2, 3]), Twice::default());
        let corners = [7, 1, 2, 3, 4, 5, 2, 7, 1, 5, 4, 3, 1, 7, 2, 1, 2, 3];
        assert_eq!(twice(&corners), Twice { count: 3, first: 2 });
    }
}
