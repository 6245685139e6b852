//! Which of some lists name an element, for each of the elements.

/// For each element the lists that name it, one after the other.
#[derive(Clone, Debug, Default)]
pub(super) struct Incidence {
    /// Those that name element `i` are `lists[starts[i]..starts[i + 1]]`, ascending.
    starts: Vec<u32>,
    lists: Vec<u32>,
}

impl Incidence {
    /// Of elements `0..count`, that lists name. Cost: linear.
    pub fn of<L: IntoIterator<Item = u32>>(count: usize, lists: impl Iterator<Item = L> + Clone) -> Self {
        let mut starts = vec![0; count + 1];
        lists.clone().flatten().for_each(|element| starts[element as usize + 1] += 1);
        for i in 0..count {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut of_all = vec![0; starts[count] as usize];
        for (number, list) in (0..).zip(lists) {
            for element in list {
                let place = &mut next[element as usize];
                of_all[*place as usize] = number;
                *place += 1;
            }
        }
        Incidence { starts, lists: of_all }
    }

    /// The numbers of the lists that name an element.
    pub fn at(&self, element: usize) -> &[u32] {
        &self.lists[self.starts[element] as usize..self.starts[element + 1] as usize]
    }

    /// The memory that it owns, in bytes.
    pub fn bytes(&self) -> usize {
        (self.starts.capacity() + self.lists.capacity()) * size_of::<u32>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_element_has_the_lists_that_name_it() {
        let lists = [vec![2, 0], vec![], vec![2, 2, 3]];
        let incidence = Incidence::of(5, lists.iter().map(|list| list.iter().copied()));
        let at: Vec<&[u32]> = (0..5).map(|element| incidence.at(element)).collect();
        assert_eq!(at, [&[0][..], &[], &[0, 2, 2], &[2], &[]]);
    }
}
