//! Macros that declare settings: each with its documentation, its default and its row in one place.

/// Declares a struct of settings, in the order of files, with their defaults.
///
/// If each default is followed by a row, the struct is a [`SettingGroup`](super::SettingGroup) whose walk has the same
/// order. `in "title": "about"` makes its section; other methods of the group may follow the fields.
///
/// ```text
/// setting_group! {
///     /// The size of a door.
///     pub struct Size in "Door": "How large the door is." {
///         /// Width, in metres.
///         width_m: f32 = 1.0,
///             number("Width", 0.5..=4.0).unit("m").hint("Narrow ones keep the wind out");
///     }
/// }
/// ```
macro_rules! setting_group {
    (
        $(#[$meta:meta])*
        pub struct $group:ident {
            $($(#[$field_meta:meta])* $field:ident: $type:ty = $default:expr;)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $group { $($(#[$field_meta])* pub $field: $type,)* }

        impl Default for $group {
            fn default() -> Self {
                Self { $($field: $default),* }
            }
        }
    };
    (
        $(#[$meta:meta])*
        pub struct $group:ident $(in $title:literal: $about:literal)? {
            $($(#[$field_meta:meta])* $field:ident: $type:ty = $default:expr, $row:expr;)*
        }
        $($method:tt)*
    ) => {
        $crate::schema::setting_group! {
            $(#[$meta])*
            pub struct $group { $($(#[$field_meta])* $field: $type = $default;)* }
        }

        $(impl $group {
            /// The section of these settings.
            pub const SECTION: $crate::schema::Section =
                $crate::schema::Section { title: $title, about: $about };
        })?

        impl $crate::schema::SettingGroup for $group {
            fn walk(&mut self, walk: &mut $crate::schema::Walk<'_>) {
                let Self { $($field),* } = self;
                $(walk.section($crate::schema::Section { title: $title, about: $about });)?
                $crate::schema::settings! { walk, $($field: $row;)* }
            }

            $($method)*
        }
    };
}

/// Visits fields of a group under their rows, with the names of the fields: `settings! { walk, width_m: number(..); }`.
macro_rules! settings {
    ($walk:ident, $($field:ident: $row:expr;)*) => {
        $($walk.setting(stringify!($field), $row, $field);)*
    };
}

/// Declares an enum whose values have names, titles and sentences, with [`Choices`](super::Choices) in the same order:
/// `pub enum Tyre { Soft = "soft", "Soft", "It gives way."; }`. The sentence is the documentation, too.
#[macro_export]
macro_rules! choices {
    (
        $(#[$meta:meta])*
        pub enum $choices:ident {
            $($(#[$more:meta])* $value:ident = $name:literal, $title:literal, $sentence:literal;)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        pub enum $choices {
            $(
                #[doc = $sentence]
                $(#[$more])*
                #[serde(rename = $name)]
                $value,
            )*
        }

        impl $crate::schema::Choices for $choices {
            const OPTIONS: &'static [Self] = &[$(Self::$value),*];

            fn choice(self) -> $crate::schema::Choice {
                match self {
                    $(Self::$value => $crate::schema::Choice::new($name, $title, $sentence),)*
                }
            }
        }
    };
}

/// Declares an enum with the list `ALL` of its values: `pub enum Side { Left; Right; }`.
macro_rules! listed_values {
    (
        $(#[$meta:meta])*
        pub enum $listed:ident {
            $($(#[$more:meta])* $value:ident;)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $listed { $($(#[$more])* $value,)* }

        impl $listed {
            /// All values, in their order.
            pub const ALL: [Self; [$(stringify!($value)),*].len()] = [$(Self::$value),*];
        }
    };
}

/// Declares an enum with the list `ALL` of its values, and with their names: `pub enum Side { Left = "left side"; }`.
macro_rules! named_values {
    (
        $(#[$meta:meta])*
        pub enum $named:ident {
            $($(#[$more:meta])* $value:ident = $name:literal;)*
        }
    ) => {
        $crate::schema::listed_values! {
            $(#[$meta])*
            pub enum $named {
                $(
                    #[doc = concat!("*", $name, "*.")]
                    $(#[$more])*
                    $value;
                )*
            }
        }

        impl $named {
            /// The name, in lower case.
            pub fn name(self) -> &'static str {
                match self { $(Self::$value => $name,)* }
            }
        }
    };
}

/// Gives a kind with a row of facts, `info()`, the names in that row: as methods, as its text, and as
/// [`Choices`](super::Choices) in the order of `ALL`.
macro_rules! named_by_info {
    ($kind:ident) => {
        impl $kind {
            /// The name in files; flags may write - for _.
            pub fn name(self) -> &'static str {
                self.info().name
            }

            /// The name at the head of a list or a chart.
            pub fn title(self) -> &'static str {
                self.info().title
            }

            /// A sentence about it.
            pub fn words(self) -> &'static str {
                self.info().words
            }
        }

        impl std::fmt::Display for $kind {
            fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.write_str(self.name())
            }
        }

        impl $crate::schema::Choices for $kind {
            const OPTIONS: &'static [Self] = &Self::ALL;

            fn choice(self) -> $crate::schema::Choice {
                $crate::schema::Choice::new(self.name(), self.title(), self.words())
            }
        }
    };
}

pub(crate) use {listed_values, named_by_info, named_values, setting_group, settings};
