//! The flags that give the parameters of the library, so that an error about a parameter names the flag: one table.

use crate::arguments::Usage;
use belvedere::{Error, Parameter};
use clap::parser::ValueSource;
use clap::{ArgMatches, Command};

/// The flags that may give a parameter, those that are more often at fault first; none where it follows from files.
pub(crate) fn flags_of(parameter: Parameter) -> &'static [&'static str] {
    match parameter {
        Parameter::Eye => &["--eye", "--panorama", "--observer", "--observers"],
        Parameter::LookAt => &["--look-at"],
        Parameter::FieldOfView => &["--fov"],
        Parameter::VerticalFieldOfView => &["--vertical-fov"],
        Parameter::PictureSize => &["--pixel", "--size", "--viewport"],
        Parameter::PixelSize => &["--pixel"],
        Parameter::DepthLimits => &["--near", "--far"],
        Parameter::ViewDirection => &["--direction", "--look-at"],
        Parameter::Viewport => &["--viewport"],
        Parameter::PixelsPerMetre => &["--density", "--viewport"],
        Parameter::BallProfile => &["--ball-profile"],
        Parameter::Observer => &["--observer", "--observers"],
        Parameter::ObserverCount => &["--spread"],
        Parameter::Network => &["--among"],
        Parameter::Tower => &["--towers"],
        Parameter::Viewpoint => &["--observer"],
        Parameter::Azimuth => &["--azimuth-range"],
        Parameter::Elevation => &["--elevation-range"],
        Parameter::Distance => &["--max-distance", "--min-distance"],
        Parameter::MaxDistance => &["--max-distance"],
        Parameter::HeightAboveGround => &["--target-height", "--observer-height"],
        Parameter::PathStep | Parameter::ProfileStep => &["--distance-step-m"],
        Parameter::VisibleHeights => &["--heights"],
        Parameter::MaxHeight | Parameter::Envelope => &["--max-height"],
        Parameter::Coverage => &["--coverage"],
        Parameter::RequiredCameras => &["--per-target"],
        Parameter::StationCount => &["--count"],
        Parameter::TargetWeight => &["--targets"],
        Parameter::ExistingCamera => &["--existing"],
        Parameter::CameraPixels => &["--pixels"],
        Parameter::Headings => &["--headings"],
        Parameter::HeadingAndTilt => &["--tilt", "--candidates", "--existing"],
        Parameter::FresnelShare => &["--fresnel-percent"],
        Parameter::Frequency => &["--frequency-ghz"],
        Parameter::Refraction => &["--refraction"],
        Parameter::AngleStep => &["--angle-step-deg"],
        Parameter::North => &["--grid-north"],
        Parameter::MinJump => &["--min-jump"],
        Parameter::ProfileLine => &["--profile-out"],
        Parameter::SunDirection => &["--sun"],
        Parameter::SunElevation => &["--sun", "--time"],
        Parameter::MinSunElevation => &["--min-sun-elevation"],
        Parameter::TimeZone => &["--zone"],
        Parameter::Date => &["--date", "--from"],
        Parameter::Year => &["--year"],
        Parameter::Time => &["--time", "--from"],
        Parameter::HoursOfDay => &["--between"],
        Parameter::Instant => &["--time", "--from"],
        Parameter::InstantCount => &["--time-step-min"],
        Parameter::Period => &["--date", "--from", "--year"],
        Parameter::TimeStep => &["--time-step-min", "--time-step-s"],
        Parameter::SunTolerance => &["--sun-tolerance-deg"],
        Parameter::Rule => &["--rule"],
        Parameter::Study => &["--study"],
        Parameter::Latitude | Parameter::Longitude | Parameter::LatitudeLongitude | Parameter::Location => {
            &["--location"]
        }
        Parameter::Air => &["--air"],
        Parameter::DirectionCount => &["--directions", "--angle-step-deg"],
        Parameter::PatchDivision => &["--patch-division"],
        Parameter::Weather => &["--weather"],
        Parameter::WeatherParts => &["--parts-per-row"],
        Parameter::Turbidity => &["--linke"],
        Parameter::Albedo => &["--albedo"],
        Parameter::WindFactor => &["--wind-factor"],
        Parameter::GroundWarming => &["--ground-warming"],
        Parameter::SunCell => &["--sun-cell-deg"],
        Parameter::Transmissivity => &["--through-trees"],
        Parameter::ThroughTrees => &["--through-trees"],
        Parameter::Leaves => &["--leaves"],
        Parameter::Ground => &["--ground"],
        Parameter::UnprovenAs => &["--unproven"],
        Parameter::Certainty => &["--certain", "--probability"],
        Parameter::Interval => &["--interval"],
        Parameter::HeldOutShare => &["--share"],
        Parameter::Targets => &["--targets", "--self", "--target-class", "--target-polygon"],
        Parameter::LastDay => &["--to"],
        Parameter::ClassMeaning => &["--class"],
        Parameter::Window => &["--windows", "--reflectors"],
        Parameter::Reflector => &["--reflectors"],
        Parameter::Scatter => &["--scatter-deg"],
        Parameter::MinSeparation => &["--from-sun-deg"],
        Parameter::RoofLength => &["--panel"],
        Parameter::RoofAngle => &["--min-area"],
        Parameter::ModuleEfficiency => &["--module-efficiency"],
        Parameter::TemperatureCoefficient => &["--temperature-coefficient"],
        Parameter::SystemLosses => &["--system-losses"],
        Parameter::InverterEfficiency => &["--inverter-efficiency"],
        Parameter::DcAcRatio => &["--dc-ac-ratio"],
        Parameter::Parcel => &["--parcel"],
        Parameter::ProtectedPlace => &["--protect"],
        Parameter::ProtectedPairs => &["--spacing", "--time-step-min"],
        Parameter::FenceHeight => &["--fence-height"],
        Parameter::AddedMesh => &["--add"],
        Parameter::ClearedArea => &["--clear"],
        Parameter::Terrain => &["--terrain"],
        Parameter::Horizon => &["--horizon"],
        Parameter::Cell => &["--cell", "--on-ground", "--on-roofs"],
        Parameter::GridBox => &["--pairs", "--route", "--observers", "--observer"],
        Parameter::Spacing => &["--spacing", "--simplify"],
        Parameter::PointRadius => &["--spacing"],
        Parameter::MeshVertex => &["--targets", "--windows", "--protect"],
        Parameter::Object => &["--object"],
        Parameter::CellOfResult => &["--cell-for"],
        Parameter::TileSize => &["--tile-size"],
        Parameter::TileMemory => &["--memory"],
        Parameter::Shard => &["--shard"],
        Parameter::Crs => &["--crs"],
        Parameter::CrsOverride => &["--crs-override"],
        Parameter::UpAxis => &["--up"],
        Parameter::OpenSurvey => &["--survey"],
        Parameter::SurveyPlace => &["--at"],
        Parameter::SurveyRadius => &["--radius"],
        Parameter::FrameTime => &["--frame-duration-s"],
        Parameter::Device => &["--device"],
        Parameter::NeighborCount | Parameter::Flatness => &["--neighbors"],
        Parameter::InitialRadius => &["--initial-radius"],
        Parameter::MaxRadius => &["--max-radius"],
        Parameter::SeparationAngle => &["--first-angle", "--next-angle"],
        Parameter::Penetration => &["--penetration"],
        Parameter::DepthBias => &["--bias"],
        Parameter::Shell => &["--shell"],
        _ => &[],
    }
}

/// An error about a parameter that a flag of the command gives, as wrong usage of this flag; any other error as it is.
pub(crate) fn with_flag(error: anyhow::Error, program: &Command, matches: &ArgMatches) -> anyhow::Error {
    let parameter = error.chain().find_map(|cause| match cause.downcast_ref() {
        Some(Error::InvalidParameter { parameter, .. }) => Some(*parameter),
        _ => None,
    });
    let mut program = program.clone();
    // flags of all commands are passed on to each
    program.build();
    match parameter.and_then(|parameter| flag_at_fault(flags_of(parameter), &program, matches)) {
        Some(flag) => Usage(format!("{flag}: {error:#}")).into(),
        None => error,
    }
}

/// The first of `flags` that was typed, else the first that the command has.
fn flag_at_fault(flags: &[&'static str], command: &Command, matches: &ArgMatches) -> Option<&'static str> {
    if let Some((name, of_command)) = matches.subcommand()
        && let Some(command) = command.find_subcommand(name)
    {
        return flag_at_fault(flags, command, of_command);
    }
    let argument = |flag: &str| command.get_arguments().find(|argument| argument.get_long() == flag.strip_prefix("--"));
    let is_typed = |flag: &str| {
        let source = argument(flag).and_then(|argument| matches.value_source(argument.get_id().as_str()));
        source == Some(ValueSource::CommandLine)
    };
    let first = |is_meant: &dyn Fn(&str) -> bool| flags.iter().copied().find(|flag| is_meant(flag));
    first(&is_typed).or_else(|| first(&|flag| argument(flag).is_some()))
}
