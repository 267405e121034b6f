//! Views on a scene, from flags.

use crate::arguments::{SizeChoice, ViewChoice, refuse};
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Scene, ViewFrom};
use belvedere::view::{CAMERA_FOV, CAMERA_SIZE, PANORAMA_WIDTH, View, default_pixel_size, to_sun};

impl ViewChoice {
    /// Returns the position and projection of a picture of a scene.
    pub(crate) fn view_from(&self, scene: &Scene, summary: &mut Summary) -> Result<ViewFrom> {
        match self.kind.panorama {
            Some(eye) => {
                let (eye, width) = (scene.frame().local_from_file(eye.0), self.panorama_width()?);
                Ok(ViewFrom::Panorama { eye, width })
            }
            None => Ok(ViewFrom::View(self.view(scene, summary)?)),
        }
    }

    /// Refuses what no scene could be seen with, before one is read.
    pub(crate) fn check(&self) -> Result<()> {
        let kind = &self.kind;
        if let Some(eye) = kind.panorama {
            View::panorama(eye.0, self.panorama_width()?)?;
        } else if let Some(eye) = kind.eye {
            self.camera(eye.0, |place| place)?;
        } else if let Some(direction) = kind.direction {
            View::parallel(direction.0, [0.0; 3], [1.0; 3], 1.0)?;
        } else if let Some(sun) = kind.sun {
            ask::check_sun(sun.0, ask::SunRange::NotBelowHorizon)?;
        } else if let Some(viewport) = &kind.viewport {
            let (vx, vy) = (viewport.vx, viewport.vy);
            View::from_viewport(viewport.p0, vx, vy, viewport.pixels_per_unit)?;
        }
        Ok(())
    }

    /// Returns true if the view is from an eye.
    pub(crate) fn is_central(&self) -> bool {
        self.kind.panorama.is_some() || self.kind.eye.is_some()
    }

    /// Width of a panorama in pixels.
    fn panorama_width(&self) -> Result<usize> {
        match self.size {
            None => Ok(PANORAMA_WIDTH),
            Some(SizeChoice::Width(width)) => Ok(width),
            Some(SizeChoice::WidthAndHeight([width, height])) if height * 2 == width => Ok(width),
            Some(SizeChoice::WidthAndHeight(_)) => {
                refuse("--size: a panorama is twice as wide as high; give only its width")
            }
        }
    }

    fn camera(&self, eye: [f64; 3], to_local: impl Fn([f64; 3]) -> [f64; 3]) -> Result<View> {
        let Some(look_at) = self.look_at else { return refuse("--eye needs --look-at") };
        let size = match self.size {
            None => CAMERA_SIZE,
            Some(SizeChoice::WidthAndHeight(size)) => size,
            Some(SizeChoice::Width(_)) => {
                return refuse("--size: --eye needs width and height, such as 1280x720");
            }
        };
        let fov = self.fov.map_or(CAMERA_FOV, f64::to_radians);
        let (near, far) = (self.near.map_or(0.0, f64::from), self.far.unwrap_or(f64::INFINITY));
        let [eye, look_at] = [eye, look_at.0].map(to_local);
        Ok(View::perspective(eye, look_at, fov, size, near, far)?)
    }

    fn view(&self, scene: &Scene, summary: &mut Summary) -> Result<View> {
        let (low, high) = scene.model().bounds().corners();
        let pixel = self.pixel.unwrap_or_else(|| default_pixel_size(low, high));
        let view = if let Some(sun) = &self.kind.sun {
            let [azimuth, elevation] = sun.0.map(f64::to_radians);
            let north = self.north.choice().of_scene(scene);
            summary.add_report(&north.report()).remarks(north.remark());
            let site = ask::SunPlace::default().site_of(scene.frame(), &scene.model().bounds(), None).ok();
            summary.remarks(ask::remark_on_sun(site.map(|(site, _)| site), sun.0));
            let sun = to_sun(azimuth - north.of_grid, elevation);
            View::parallel(sun.map(|v| -v), low, high, pixel)?
        } else if let Some(direction) = &self.kind.direction {
            View::parallel(direction.0, low, high, pixel)?
        } else if let Some(viewport) = &self.kind.viewport {
            let scale = scene.frame().crs.metres_per_unit_xyz();
            let metres = |v: [f64; 3]| std::array::from_fn(|i| v[i] * scale[i]);
            let view = View::from_viewport(
                scene.frame().local_from_file(viewport.p0),
                metres(viewport.vx),
                metres(viewport.vy),
                viewport.pixels_per_unit / scale[0],
            );
            view?
        } else if let Some(eye) = &self.kind.eye {
            self.camera(eye.0, |place| scene.frame().local_from_file(place))?
        } else {
            return refuse("a view is missing: give --viewport, --sun, --direction, --eye or --panorama");
        };
        Ok(view)
    }
}
