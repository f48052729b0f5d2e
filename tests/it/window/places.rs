//! Finds controls in the window by name, using the list that the program writes for `--places`.

use super::display::{PLACES, Studio};

/// A rectangle of the window, in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Area {
    pub left: i32,
    pub top: i32,
    pub right: i32,
    pub bottom: i32,
}

impl Area {
    /// Returns the width, in pixels.
    pub fn width(self) -> i32 {
        self.right - self.left
    }

    /// Returns the height, in pixels.
    pub fn height(self) -> i32 {
        self.bottom - self.top
    }

    /// Returns the point at these fractions of width and height.
    pub fn at(self, x: f64, y: f64) -> (i32, i32) {
        let along = |from: i32, length: i32, share: f64| from + (f64::from(length) * share) as i32;
        (along(self.left, self.width(), x), along(self.top, self.height(), y))
    }

    /// Returns the centre.
    pub fn middle(self) -> (i32, i32) {
        self.at(0.5, 0.5)
    }
}

/// A control or a text in the window.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// Role of the control: `Button`, `Slider`, `Label` and so on.
    pub role: String,
    /// Label of the control.
    pub label: String,
    /// Value of the control; `on` or `off` for check boxes and toggles.
    pub value: String,
    /// Rectangle of the control.
    pub area: Area,
}

impl Place {
    fn of_line(line: &str) -> Option<Self> {
        let mut parts = line.split('\t');
        let role = parts.next()?.to_owned();
        let mut end = || parts.next()?.parse().ok();
        let area = Area { left: end()?, top: end()?, right: end()?, bottom: end()? };
        let [label, value] = [parts.next()?, parts.next()?].map(ToOwned::to_owned);
        Some(Self { role, label, value, area })
    }
}

impl Studio {
    /// Returns the number of frames that the program has drawn.
    pub fn frame(&self) -> u64 {
        let frame = self.find(|place| place.role == "Frame");
        frame.map_or(0, |place| place.value.parse().expect("a number"))
    }

    /// Waits until `count` more frames are drawn.
    pub fn wait_for_frames(&self, count: u64) {
        let last = self.frame() + count;
        self.wait(|| self.frame() >= last, || format!("frame {last}"));
    }

    /// Returns all listed controls, including those that are scrolled out of sight.
    pub fn places(&self) -> Vec<Place> {
        // The file is written atomically and does not exist before the first frame.
        let text = std::fs::read_to_string(self.folder().join(PLACES)).unwrap_or_default();
        text.lines().filter_map(Place::of_line).collect()
    }

    /// Returns the first control that meets a condition.
    pub fn find(&self, is: impl Fn(&Place) -> bool) -> Option<Place> {
        self.places().into_iter().find(is)
    }

    /// Waits for a control that meets a condition and does not move; `what` describes it in the failure message.
    pub fn place_where(&self, what: &str, is: impl Fn(&Place) -> bool) -> Place {
        let listed = || {
            let places = self.places().into_iter();
            let lines = places.map(|place| format!("{} {:?}", place.role, place.label));
            format!("{what} among\n{}\n{:?}", lines.collect::<Vec<_>>().join("\n"), self.title())
        };
        loop {
            self.wait(|| self.find(&is).is_some(), listed);
            // A widget that was just opened moves to its place in the next frame.
            let area = |place: Option<Place>| place.map(|place| place.area);
            let before = area(self.find(&is));
            self.wait_for_frames(1);
            let now = self.find(&is);
            if before.is_some()
                && area(now.clone()) == before
                && let Some(place) = now
            {
                return place;
            }
        }
    }

    /// Waits for a control with this label or, without one, for a text.
    pub fn place(&self, label: &str) -> Place {
        let place = self.place_where(label, |place| place.label == label);
        let control = self.find(|place| place.label == label && place.role != "Label");
        control.unwrap_or(place)
    }

    /// Waits for a control with this role and label.
    pub fn place_of(&self, role: &str, label: &str) -> Place {
        let what = format!("{role} {label:?}");
        self.place_where(&what, |place| place.role == role && place.label == label)
    }

    /// Waits for a control whose label contains a text.
    pub fn place_with(&self, part: &str) -> Place {
        self.place_where(part, |place| place.label.contains(part))
    }

    /// Waits until no label contains a text.
    pub fn wait_for_no(&self, part: &str) {
        let is_gone = || self.find(|place| place.label.contains(part)).is_none();
        self.wait(is_gone, || format!("no {part:?}"));
    }

    /// Returns the value of the control with this role and label.
    pub fn value_of(&self, role: &str, label: &str) -> String {
        self.place_of(role, label).value
    }

    /// Waits until the control with this role and label has this value.
    pub fn wait_for_value(&self, role: &str, label: &str, value: &str) {
        let now = || self.place_of(role, label).value;
        self.wait(|| now() == value, || format!("{label} {value:?}, which is {:?}", now()));
    }

    /// Clicks the centre of the control with this label.
    pub fn click_label(&self, label: &str) {
        self.click_at(self.place(label).area.middle());
    }

    /// Clicks the centre of the button whose label starts with a text.
    pub fn click_starting(&self, start: &str) {
        let is_it = |place: &Place| place.role == "Button" && place.label.starts_with(start);
        self.click_at(self.place_where(start, is_it).area.middle());
    }

    /// Clicks a control while a key such as `ctrl` is held down.
    pub fn click_with(&self, key: &str, place: &Place) {
        self.holding(key, || self.click_at(place.area.middle()));
    }

    /// Brings a panel to the front.
    pub fn open_panel(&self, name: &str) {
        let tab = format!("Panel {name}");
        // Panels that are rarely needed open on demand.
        if self.find(|place| place.label == tab).is_none() {
            self.choose("Panels", name);
        } else {
            self.click_label(&tab);
        }
    }

    /// Opens a menu and selects an entry.
    pub fn choose(&self, menu: &str, action: &str) {
        self.click_at(self.place_of("Button", menu).area.middle());
        self.click_starting(action);
    }

    /// Drags a slider to a fraction of its rail.
    pub fn drag_slider(&self, label: &str, share: f64) {
        let rail = self.scrolled_to("Slider", label).area;
        self.drag(1, rail.at(0.5, 0.5), rail.at(share, 0.5));
    }

    /// Replaces the text of a field and presses Enter.
    pub fn type_into(&self, label: &str, text: &str) {
        self.click_at(self.scrolled_to("TextInput", label).area.middle());
        self.retype(text);
        self.key("Return");
    }

    /// Waits for a control of the upper panels, scrolling until it is visible.
    pub fn scrolled_to(&self, role: &str, label: &str) -> Place {
        self.scrolled_to_where(label, |place| place.role == role && place.label == label)
    }

    /// Waits for a control of the upper panels that meets a condition, scrolling until it is visible.
    pub fn scrolled_to_where(&self, what: &str, is: impl Fn(&Place) -> bool) -> Place {
        let top = self.place("Panel Watch").area;
        let below = self.find(|place| place.label == "Panel Champions").map(|tab| tab.area.top);
        // In a low window all panels are side by side at full height.
        let bottom = below.filter(|below| *below > top.bottom).unwrap_or(self.size.1);
        for _ in 0..40 {
            let place = self.place_where(what, &is);
            let is_above = place.area.top < top.bottom;
            if !is_above && place.area.bottom < bottom {
                return place;
            }
            self.wheel(is_above, (top.left + 100, bottom - 12));
        }
        panic!("{what} could not be scrolled into sight");
    }

    /// Scrolls to a fold of the upper panels and opens or closes it.
    pub fn fold(&self, label: &str) {
        let place = self.scrolled_to_where(label, |place| place.label == label);
        self.click_at(place.area.middle());
    }

    /// Scrolls to a control of the upper panels and clicks it.
    pub fn scroll_and_click(&self, role: &str, label: &str) {
        self.click_at(self.scrolled_to(role, label).area.middle());
    }

    /// Returns a row of the list of champions: 0 is the saved champion, 1 that of the first generation.
    pub fn champion(&self, row: u32) -> Place {
        let tab = self.place("Panel Champions").area;
        // A row that is partly hidden by the names of the columns cannot be clicked in its middle.
        let head = self.find(|place| place.label == "Energy" && place.area.top > tab.bottom);
        let top = head.map_or(tab.bottom, |head| head.area.bottom);
        let generation = format!("Generation {row}");
        let is_it = |place: &Place| {
            let rest = place.label.strip_prefix(if row == 0 { "climber" } else { &generation });
            let is_named = rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_digit()));
            let is_here = place.area.middle().1 > top && place.area.right < self.stage().left;
            place.role == "Button" && is_named && is_here
        };
        let bottom = self.size.1;
        for _ in 0..40 {
            match self.find(is_it) {
                Some(place) if place.area.middle().1 < bottom - 4 => return place,
                // Rows out of sight are not listed. The saved champion is at the top.
                _ => self.wheel(row == 0, (tab.left + 100, bottom - 40)),
            }
        }
        panic!("no row for champion {row}");
    }

    /// Clicks a row of the list of champions: 0 is the saved champion, 1 that of the first generation.
    pub fn click_champion(&self, row: u32) {
        self.click_at(self.champion(row).area.middle());
    }

    /// Clicks a row of the list of champions with Shift held down.
    pub fn shift_click_champion(&self, row: u32) {
        let place = self.champion(row);
        self.click_with("shift", &place);
    }

    /// Returns the area of the stage.
    pub fn stage(&self) -> Area {
        let stage = self.find(|place| place.label == "The stage");
        stage.unwrap_or_else(|| self.place("The stage")).area
    }

    /// Returns the area of the stage that only the board of a race can cover.
    pub fn scene(&self) -> Area {
        let Area { left, top, right, bottom } = self.stage();
        let cards = if self.find(|place| place.label == "Follow").is_some() { 100 } else { 10 };
        Area { left: left + 10, top: top + cards, right: right - 10, bottom: bottom - 10 }
    }

    /// Seeks to this fraction of the trial's duration.
    pub fn seek(&self, share: f64) {
        self.click_at(self.place("Time, in simulated seconds").area.at(share, 0.5));
    }
}
