//! Every method by name, ready to be built from a survey.

use crate::dsm::{Dsm, DsmParams};
use crate::hidden_points::{ForeignTargets, HiddenPoints, HiddenPointsParams};
use crate::implicit_surface::{ImplicitSurface, ImplicitSurfaceParams};
use crate::medial::{MedialBaseline, MedialParams, Outward};
use crate::mesh_rays::{MeshRays, MeshRaysParams};
use crate::poisson::{Poisson, PoissonParams};
use crate::shadow_map::{ShadowMap, ShadowMapParams};
use crate::splatting::{SplatParams, Splats};
use crate::voxels::{VoxelParams, Voxels};
use crate::{MethodInput, PlaceModel};
use belvedere::medial::{CarvedParams, Rule, Trees};
use belvedere::model::BallParams;
use belvedere::query::{BlockRule, Visibility};
use belvedere::{Mesh, PointCloud, Result};

/// When a comparison of all methods takes one in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Listing {
    /// Unless other methods are requested.
    Always,
    /// Only where it is requested by its full key: a variant that shows the effect of a part of another method.
    WhenNamed,
    /// On held-out pulses, elsewhere only where it is requested by its full key.
    OnHeldOutPulses,
}

/// What a method does anew for each eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PerEye {
    /// Nothing that takes long.
    Cheap,
    /// A hull of all points, or six pictures of a shadow map.
    Costly,
}

/// A way of answering visibility, not built yet.
pub struct Method<'a> {
    /// Name on the command line and in file names: lower case, digits and hyphens.
    pub key: String,
    /// Name in tables.
    pub title: String,
    /// Its page below `docs/methods`, without the extension.
    pub page: &'static str,
    /// When a comparison takes it in.
    pub listing: Listing,
    /// What another eye costs.
    pub per_eye: PerEye,
    build: Box<dyn Fn() -> Result<Box<dyn Visibility + 'a>> + Sync + 'a>,
}

impl<'a> Method<'a> {
    fn new<V: Visibility + 'a>(
        key: impl Into<String>,
        title: impl Into<String>,
        page: &'static str,
        build: impl Fn() -> Result<V> + Sync + 'a,
    ) -> Self {
        let build = Box::new(move || build().map(|built| Box::new(built) as Box<dyn Visibility + 'a>));
        Self { key: key.into(), title: title.into(), page, listing: Listing::Always, per_eye: PerEye::Cheap, build }
    }

    fn costly_per_eye(self) -> Self {
        Self { per_eye: PerEye::Costly, ..self }
    }

    fn on_held_out_pulses(self) -> Self {
        Self { listing: Listing::OnHeldOutPulses, ..self }
    }

    fn when_named(self) -> Self {
        Self { listing: Listing::WhenNamed, ..self }
    }

    /// Builds it.
    ///
    /// # Errors
    /// Those of the method.
    pub fn build(&self) -> Result<Box<dyn Visibility + 'a>> {
        (self.build)()
    }
}

/// Bound of the noise given to the robust hidden point removal, metres: three times what data sheets of airborne
/// scanners state.
const NOISE: f64 = 0.06;

/// How near to a target a mesh may lie without blocking it, metres: points of a cloud lie up to a decimetre behind the
/// surface that the model gives them.
const MESH_CLEARANCE: f64 = 0.1;

/// Carved balls for surveys in winter, for targets in the air: crowns are twigs, and nothing gives way to targets.
fn carved_for_winter() -> MedialParams {
    let carving = CarvedParams::default().with_trees(Trees::Porous);
    let blocking = BlockRule { shell: 0.0, ..BlockRule::carved() };
    MedialParams { making: BallParams::Carved(carving), blocking, ..MedialParams::carved() }
}

/// Carved balls without one rule: key, title and parameters. They run when named.
fn carved_variants() -> impl Iterator<Item = (String, String, MedialParams)> {
    Rule::ALL.into_iter().map(|rule| {
        let making = BallParams::Carved(CarvedParams::default().without(rule));
        let name = rule.name();
        let params = MedialParams { making, ..MedialParams::carved() };
        (format!("carved-without-{name}"), format!("carved balls without {name}"), params)
    })
}

/// The methods that a survey allows, in the order of tables: those that need the cloud alone, then for each model those
/// that trace it, then Belvedere's own and variants of them.
#[must_use]
pub fn methods<'a>(survey: &'a MethodInput<'a>) -> Vec<Method<'a>> {
    let (cloud, positions, origin) = (survey.cloud, &survey.cloud.positions, survey.cloud.frame.origin);
    let medial = |key: &str, title: &str, params: MedialParams| {
        Method::new(key, title, "medial-balls", move || MedialBaseline::new(survey, Outward::Survey, &params))
    };
    let hidden_points = |key: &str, title: &str, params: HiddenPointsParams| {
        Method::new(key, title, "hidden-points", move || HiddenPoints::new(survey, params)).costly_per_eye()
    };
    let splats = |key: &str, title: &str, params: SplatParams| {
        Method::new(key, title, "splats", move || Splats::new(cloud, &params))
    };
    let voxels = |key: &str, title: &str, size: f64| {
        let params = VoxelParams { size, ..VoxelParams::default() };
        Method::new(key, title, "voxels", move || Voxels::new(positions, &params))
    };
    let inserting = HiddenPointsParams { foreign_targets: ForeignTargets::Insert, ..HiddenPointsParams::default() };
    let robust = HiddenPointsParams { noise: NOISE, ..inserting };
    let mut methods = vec![
        medial("paper-cone", "paper as published (cone)", MedialParams::published()),
        medial("paper-sphere", "paper, spheres", MedialParams::published_with_spheres()),
        medial("union", "unfiltered union of balls", MedialParams::unfiltered_union()),
        hidden_points("hidden-points", "hidden point removal (targets inserted)", inserting),
        hidden_points("hidden-points-robust", "the same, robust to noise", robust),
        splats("surfels", "splats: surfels", SplatParams::surfels()),
        splats("depth-splats", "splats: sprites", SplatParams::depth_splats()),
        splats("elliptical-splats", "splats: ellipses", SplatParams::object_space()),
        Method::new("implicit-surface", "implicit surface", "implicit-surface", move || {
            ImplicitSurface::new(survey, &ImplicitSurfaceParams::default())
        }),
        Method::new("poisson", "screened Poisson surface", "poisson", move || {
            Poisson::new(survey, &PoissonParams::default())
        }),
        voxels("voxels-05", "voxels 0.5 m", 0.5),
        voxels("voxels-10", "voxels 1 m", 1.0),
        Method::new("dsm", "highest-point raster", "dsm", move || Dsm::from_points(positions, &DsmParams::default())),
    ];
    // as the paper did it: signs of normals from a city model
    methods.extend(survey.models.first().map(|PlaceModel { name, mesh }| {
        let (key, title) = (format!("paper-cone-{name}"), format!("paper as published, signs by {name}"));
        Method::new(key, title, "medial-balls", move || {
            MedialBaseline::new(survey, Outward::Model(mesh), &MedialParams::published())
        })
    }));
    let on_mesh = MeshRaysParams { clearance: MESH_CLEARANCE };
    for PlaceModel { name, mesh } in survey.models {
        methods.push(Method::new(format!("mesh-{name}"), format!("rays on {name}"), "mesh-rays", move || {
            MeshRays::new(mesh, origin, &on_mesh)
        }));
        let (key, title) = (format!("shadow-map-{name}"), format!("shadow map of {name}"));
        let shadow_map = move || ShadowMap::new(mesh, origin, &ShadowMapParams::default());
        methods.push(Method::new(key, title, "shadow-map", shadow_map).costly_per_eye());
        methods.push(Method::new(format!("dsm-{name}"), format!("raster of {name}"), "dsm", move || {
            Dsm::from_mesh(mesh, origin, &DsmParams::default())
        }));
    }
    methods.push(medial("tau", "balls limited to half a metre", MedialParams::cut_to_half_a_metre()));
    methods.push(medial("carved", "Belvedere: carved balls", MedialParams::carved()));
    let winter = medial("carved-porous", "the same, --trees porous --shell 0", carved_for_winter());
    methods.push(winter.on_held_out_pulses());
    methods.extend(carved_variants().map(|(key, title, params)| medial(&key, &title, params).when_named()));
    methods
}

/// Keys of all methods that there are for a survey with models of these names.
#[must_use]
pub fn method_keys(models: &[&str]) -> Vec<String> {
    let cloud = PointCloud::default();
    let model = |name: &&str| PlaceModel { name: (*name).to_owned(), mesh: Mesh::default() };
    let models: Vec<PlaceModel> = models.iter().map(model).collect();
    let survey = MethodInput { cloud: &cloud, scanner: &[], models: &models };
    methods(&survey).into_iter().map(|method| method.key).collect()
}
