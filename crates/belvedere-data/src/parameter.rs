//! The parameters that can lie outside their range: the subjects of errors, without their words.

use std::fmt;

macro_rules! parameters {
    ($($(#[$doc:meta])+ $variant:ident => $name:literal,)+) => {
        /// Subject of an [`Error::InvalidParameter`](crate::Error::InvalidParameter). Functions share a parameter with
        /// the same meaning.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Parameter {
            $($(#[$doc])+ $variant,)+
        }

        impl Parameter {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$variant,)+];

            /// Its name in messages.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)+
                }
            }
        }
    };
}

parameters! {
    // Views
    /// Position that is looked from.
    Eye => "eye",
    /// Point that a camera looks at.
    LookAt => "point to look at",
    /// Horizontal angle that a camera sees.
    FieldOfView => "field of view",
    /// Vertical angle that a camera sees.
    VerticalFieldOfView => "vertical field of view",
    /// Pixels of a picture.
    PictureSize => "picture size",
    /// Side of a pixel of a parallel view, metres.
    PixelSize => "pixel size",
    /// Depths between which a camera sees.
    DepthLimits => "near and far limit",
    /// Direction that a view looks in.
    ViewDirection => "view direction",
    /// Corner and sides of a viewport.
    Viewport => "viewport",
    /// Pixels of a metre, in a viewport or required of a camera.
    PixelsPerMetre => "pixels per metre",
    /// View, or several from one eye.
    View => "view",
    /// Shape that a ball has in a picture.
    BallProfile => "ball profile",
    // Observers, cameras and landmarks
    /// Place of an observer.
    Observer => "observer",
    /// Number of observers spread over a map.
    ObserverCount => "number of observers",
    /// Places of which a network tells which see each other.
    Network => "network",
    /// Place from which a page shows the visible parts of the scene.
    Viewpoint => "viewpoint",
    /// Tower of which visible metres are computed.
    Tower => "tower",
    /// Azimuths between which an observer sees.
    Azimuth => "azimuth",
    /// Elevations between which an observer sees.
    Elevation => "elevation in degrees",
    /// Distances between which an observer or a camera sees.
    Distance => "distance",
    /// Distance up to which something is seen.
    MaxDistance => "maximum distance",
    /// Height of a target or an observer above the ground or the terrain.
    HeightAboveGround => "height above the ground",
    /// Distance between places on a path.
    PathStep => "step along the path",
    /// Height up to which a map or an envelope goes.
    MaxHeight => "maximum height",
    /// Height above the ground that something must have to be seen.
    VisibleHeights => "lowest visible height",
    /// Share of the targets that cameras must see.
    Coverage => "coverage",
    /// Cameras that must see each target.
    RequiredCameras => "cameras on each target",
    /// Stations of a scanner that are to be chosen.
    StationCount => "number of stations",
    /// Targets that are looked at together, or of a table.
    TargetCount => "number of targets",
    /// Number of a target.
    Target => "target",
    /// Targets of a question.
    Targets => "targets",
    /// Weight of a target.
    TargetWeight => "weight of a target",
    /// Camera that stays.
    ExistingCamera => "existing camera",
    /// Pixels across the picture of a camera.
    CameraPixels => "pixels",
    /// Directions tried for each camera.
    Headings => "headings",
    /// Direction of a camera.
    HeadingAndTilt => "heading and tilt in degrees",
    /// Share of the first Fresnel zone.
    FresnelShare => "share of the Fresnel zone that must be free",
    /// Frequency, gigahertz.
    Frequency => "frequency of a radio link",
    /// Coefficient of refraction of lines of sight.
    Refraction => "coefficient of refraction",
    /// Radius of the earth, metres.
    EarthRadius => "radius of the earth",
    /// Angle between rays around a point.
    AngleStep => "step of angles in degrees",
    /// Angle between grid north and true north.
    North => "turn of north",
    /// Change of distance that makes an occluding edge.
    MinJump => "minimum jump",
    /// Line under which a profile is made.
    ProfileLine => "line of a profile",
    /// Distance between the rows of a profile.
    ProfileStep => "step of a profile",
    // Sun, sky and weather
    /// Direction to the sun.
    SunDirection => "direction to the sun",
    /// Elevation of the sun.
    SunElevation => "elevation of the sun",
    /// Elevation below which the sun does not count.
    MinSunElevation => "minimum elevation of the sun",
    /// Time zone of clocks.
    TimeZone => "time zone",
    /// A day.
    Date => "date",
    /// Year of days that are given without one.
    Year => "year",
    /// A date and a time of day.
    Time => "time",
    /// Hours of a day, as clocks show them.
    HoursOfDay => "hours of a day",
    /// An instant, seconds since 1970.
    Instant => "instant",
    /// Suns of an envelope.
    InstantCount => "number of instants",
    /// Days or a span of time.
    Period => "period",
    /// Last day of a period.
    LastDay => "last day",
    /// Time between samples.
    TimeStep => "step of time",
    /// Angle within which suns share a direction.
    SunTolerance => "angle between a sun and its direction",
    /// Hours of sun that suffice.
    SufficientHours => "hours of sun",
    /// A daylight rule.
    Rule => "rule",
    /// A shadow study of a city.
    Study => "shadow study",
    /// Latitude of a site.
    Latitude => "latitude",
    /// Longitude of a site.
    Longitude => "longitude",
    /// Height of a site above the sea.
    SiteHeight => "height of the site",
    /// Pressure and temperature of the air.
    Air => "air",
    /// Directions around a place, or of the sky.
    DirectionCount => "number of directions",
    /// Division of the patches of the sky.
    PatchDivision => "division of sky patches",
    /// Rows of weather and their place.
    Weather => "weather",
    /// Parts of a row of weather, each with a sun of its own.
    WeatherParts => "parts of a row of weather",
    /// Linke turbidity of the air.
    Turbidity => "Linke turbidity",
    /// Content of the air that scatters light.
    AirContent => "content of the air",
    /// Share of light that the ground sends back.
    Albedo => "albedo",
    /// Factor of the wind.
    WindFactor => "factor of the wind",
    /// Surfaces of a scene.
    Surfaces => "surfaces of the scene",
    /// Share of the warming of sunlit surfaces.
    GroundWarming => "share of the warming of sunlit surfaces",
    /// Cell that gathers suns.
    SunCell => "cell of sun directions in degrees",
    /// Share of light that passes crowns.
    Transmissivity => "transmissivity",
    /// Light through trees.
    ThroughTrees => "light through trees",
    /// Leaves of trees.
    Leaves => "leaves",
    /// Meaning of a class of points.
    ClassMeaning => "class of points",
    /// Place, direction and size of a window.
    Window => "window",
    // Roofs, parcels and plans
    /// Distances and cells that make roof planes.
    RoofLength => "length for roof planes",
    /// Angles and areas that make roof planes.
    RoofAngle => "angle or area for roof planes",
    /// Power of a square metre of solar panels.
    ModuleEfficiency => "module efficiency",
    /// Change of the power of solar panels with their temperature.
    TemperatureCoefficient => "temperature coefficient",
    /// Share of the direct current that a photovoltaic system loses.
    SystemLosses => "system losses",
    /// Efficiency of an inverter.
    InverterEfficiency => "inverter efficiency",
    /// Power of solar panels for each power of their inverter.
    DcAcRatio => "ratio of direct to alternating power",
    /// Rings of a parcel.
    Parcel => "parcel",
    /// Place that keeps its sun.
    ProtectedPlace => "protected place",
    /// Pairs to test for an envelope.
    ProtectedPairs => "number of pairs of a protected piece and a sun",
    /// Height at which lines are protected.
    FenceHeight => "height of the fence",
    /// Solar envelope to be written as a solid.
    Envelope => "envelope",
    /// Mesh of a planned building.
    AddedMesh => "mesh to add",
    /// Area or class that is removed.
    ClearedArea => "area to clear",
    /// Raster of heights beyond the cloud.
    Terrain => "terrain",
    /// Rows of a horizon.
    Horizon => "horizon",
    // Grids, meshes and samples
    /// Side of cells.
    Cell => "cell",
    /// Box that a grid covers.
    GridBox => "box of the grid",
    /// Distance between samples.
    Spacing => "spacing of samples",
    /// Distance of samples before their faces.
    SampleOffset => "distance of sample points from their faces",
    /// Size of the surface that a point has.
    PointRadius => "maximum radius of a point",
    /// Triangles of a mesh.
    Mesh => "mesh",
    /// Corner of a mesh.
    MeshVertex => "vertex of the mesh",
    /// Panel or pane that reflects the sun.
    Reflector => "reflector",
    /// Angle by which reflectors spread light.
    Scatter => "scatter",
    /// Minimum angle between a reflection and the sun itself.
    MinSeparation => "angle from the sun",
    /// Name of an object of a mesh.
    Object => "object",
    /// Size and place of a raster.
    Raster => "raster",
    // Whole cities
    /// Side of the cells of some results.
    CellOfResult => "cell of some results",
    /// Side of tiles.
    TileSize => "tile size",
    /// Memory that a tile may take.
    TileMemory => "memory for a tile",
    /// Results of a plan.
    Questions => "questions",
    /// Share of the tiles that a run computes.
    Shard => "share of the tiles",
    /// Width and height of a survey.
    Extent => "extent of the survey",
    // Files and reference systems
    /// Text of a reference system.
    Crs => "crs",
    /// Precedence of a given reference system over the files.
    CrsOverride => "crs_override",
    /// Reference system of a cloud or of targets.
    ReferenceSystem => "reference system",
    /// Latitude and longitude to project.
    LatitudeLongitude => "latitude and longitude",
    /// Place on earth, where nothing but the user can say it.
    Location => "location",
    /// Axis of a file that is up.
    UpAxis => "axis that is up",
    /// Box within which points are read.
    ReadBox => "box to read",
    /// Open survey to take points of.
    OpenSurvey => "survey",
    /// Place to find open surveys of.
    SurveyPlace => "place",
    /// Half of the side of an area of an open survey.
    SurveyRadius => "radius",
    /// Level of detail of CityJSON.
    LevelOfDetail => "level of detail",
    /// Columns of results in a file.
    ResultColumns => "result columns",
    /// Number and size of the frames of a film.
    Frames => "frames of a film",
    /// Display time of a frame of a film.
    FrameTime => "time of a frame",
    /// Device that computes.
    Device => "device",
    // Clouds, normals and scanners
    /// Position of a point or on a map.
    Position => "position",
    /// Points of a cloud.
    PointCount => "number of points",
    /// Neighbours of a point that are looked at.
    NeighborCount => "number of neighbours",
    /// Flatness of neighbours for a normal.
    Flatness => "flatness",
    /// Orientation of normals.
    Orientation => "orientation",
    /// Positions of scanners.
    ScannerPositions => "scanner positions",
    /// Path of a scanner, with its times.
    Trajectory => "trajectory",
    /// Setting with which scanner positions are estimated.
    ScannerEstimate => "setting of the scanner estimate",
    /// Radius within which an isolated point has no neighbours.
    IsolationRadius => "isolation radius",
    /// Distance of near duplicates.
    DuplicateDistance => "near duplicate distance",
    /// Setting of the detection of ground.
    GroundDetection => "ground detection",
    /// Ground below places.
    Ground => "ground",
    /// Reach of the ground beyond its points.
    GroundReach => "reach of the ground",
    /// Setting of a surface of points.
    Surface => "surface of points",
    // Balls, and how they block
    /// Balls of a model.
    BallCount => "number of balls",
    /// Place, size or transmission of a ball.
    Ball => "ball",
    /// Side of the surface that balls lie on.
    BallSide => "side of the balls",
    /// Origin of a frame.
    Origin => "origin",
    /// Radius that balls shrink from.
    InitialRadius => "initial radius",
    /// Radius that balls have at most.
    MaxRadius => "greatest radius",
    /// Ratio of radii of the two sides of a surface.
    RadiusRatio => "ratio of radii",
    /// Angle at which a ball stops shrinking.
    SeparationAngle => "separation angle",
    /// Depth to which points may lie in a ball.
    Penetration => "penetration",
    /// Angle of balls that count for the feature size.
    BisectorAngle => "bisector angle",
    /// Densities between which a cloud is simplified.
    DensityLimits => "density limits",
    /// Distance before a ball at which a target is still visible.
    DepthBias => "depth bias",
    /// Distance that balls are made smaller by.
    Shell => "shell",
    /// A direction of a matrix.
    Direction => "direction",
    /// Box around an obstacle.
    Obstacle => "box of an obstacle",
    /// Part of a pulse that proves space empty.
    Pulse => "pulse",
    /// Distance within which a pulse proves space empty.
    PulseNearness => "nearness of pulses",
    /// Length that may stay unproven.
    UnprovenLength => "maximum unproven length",
    /// Treatment of unproven answers.
    UnprovenAs => "unproven",
    /// Minimum certainty of an answer.
    Certainty => "certainty",
    /// Choice to give an interval that holds the truth.
    Interval => "interval",
    /// Share of the pulses that are kept out to measure with.
    HeldOutShare => "share of the pulses that are kept out",
    /// Step along unproven space.
    UnprovenStep => "step along unproven space",
    // Other methods, which are compared
    /// Setting of a method that is compared.
    MethodSetting => "setting of a method",
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::Parameter;
    use std::collections::HashSet;

    #[test]
    fn each_has_a_name_of_its_own() {
        let names: HashSet<&str> = Parameter::ALL.iter().map(|parameter| parameter.name()).collect();
        assert_eq!(names.len(), Parameter::ALL.len());
        assert!(names.iter().all(|name| !name.is_empty() && name.trim() == *name));
    }
}
