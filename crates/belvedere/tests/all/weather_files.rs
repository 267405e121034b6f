//! Weather files: what the readers make of each format, and what they refuse.

use belvedere::apps::irradiance::weather_instants;
use belvedere::apps::sun::Site;
use belvedere::io::read_weather;
use belvedere::weather::{CalendarDay, RowsHold, Weather, unix_day};

fn read(text: &str) -> belvedere::Result<Weather> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("weather.file");
    std::fs::write(&path, text).unwrap();
    read_weather(&path)
}

fn instant(year: i32, month: u8, day: u8, hour: f64) -> f64 {
    unix_day(CalendarDay::new(year, month, day).unwrap()) as f64 * 86_400.0 + hour * 3600.0
}

fn epw_row(date: &str, ghi: &str, dni: &str, dhi: &str) -> String {
    // temperature is cell 7, radiation cells 14 to 16
    let cells = ["?9?9", "10.5", "3.0", "60", "101000", "0", "0", "300"];
    format!("{date},{},{ghi},{dni},{dhi},0,0,0,0,180,2.0\n", cells.join(","))
}

fn epw(rows: &str) -> String {
    let head = "LOCATION,Town,-,NLD,TMYx,062400,52.3,4.77,1.0,-3.0\nDESIGN CONDITIONS,0\nTYPICAL/EXTREME PERIODS,0\n\
                GROUND TEMPERATURES,0\nHOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\nCOMMENTS 1,\nCOMMENTS 2,\n\
                DATA PERIODS,1,1,Data,Sunday,1/1,12/31\n";
    format!("{head}{rows}")
}

#[test]
fn hours_of_epw_end_in_local_standard_time() {
    let rows = epw_row("1999,6,21,13,60", "800", "700", "150") + &epw_row("2003,12,31,24,0", "9999", "0", "9999");
    let weather = read(&epw(&rows)).unwrap();
    assert_eq!((weather.format, weather.rows_hold), ("EPW", RowsHold::Means));
    assert!((weather.latitude.to_degrees() - 52.3).abs() < 1e-9 && (weather.height - -3.0).abs() < 1e-9);
    // hour 13 is 12:00 to 13:00 in a zone one hour ahead of UTC: its middle is 11:30 UTC
    let step = weather.steps[0];
    assert_eq!((step.instant, step.hours, step.month), (instant(1999, 6, 21, 11.5), 1.0, 6));
    assert_eq!(
        (step.ghi, step.dni, step.dhi, step.air.temperature),
        (Some(800.0), Some(700.0), Some(150.0), Some(10.5))
    );
    // the other has neither global radiation nor both of its parts
    assert_eq!((weather.steps.len(), weather.left_out_count), (1, 1));
    // missing direct and diffuse radiation is not zero; noise at night is
    let rows = epw_row("1999,6,21,13,60", "800", "9999", "9999") + &epw_row("1999,6,22,1,60", "-1.5", "0", "0");
    let weather = read(&epw(&rows)).unwrap();
    assert_eq!((weather.steps[0].dni, weather.steps[0].dhi, weather.steps[1].ghi), (None, None, Some(0.0)));
    // four records an hour end at their minutes
    let quarters = epw(&epw_row("1999,6,21,13,15", "800", "700", "150")).replace("PERIODS,1,1,", "PERIODS,1,4,");
    let step = read(&quarters).unwrap().steps[0];
    assert_eq!((step.instant, step.hours), (instant(1999, 6, 21, 12.0 + 0.125 - 1.0), 0.25));
}

const PVGIS_TYPICAL: &str = "Latitude (decimal degrees): 45.000\r\nLongitude (decimal degrees): 8.000\r\nElevation (m): 250.0\r\n\
    Irradiance Time Offset (h): 0.1761\r\nmonth,year\r\n1,2016\r\n2,2008\r\n\
    time(UTC),T2m,RH,G(h),Gb(n),Gd(h),IR(h),WS10m,WD10m,SP\r\n\
    20160101:1100,3.1,80.2,310.0,520.5,95.0,270.1,1.2,90.0,98000.0\r\n\
    20080229:1200,9.9,50.0,500.0,-0.0,500.0,270.1,1.2,90.0,98000.0\r\n\r\n\
    T2m: 2-m air temperature (degree Celsius)\r\nPVGIS (c) European Union, 2001-2026\r\n";

#[test]
fn rows_of_pvgis_are_instants_of_utc_with_an_offset() {
    let weather = read(PVGIS_TYPICAL).unwrap();
    assert_eq!(
        (weather.format, weather.rows_hold, weather.steps.len()),
        ("PVGIS, typical year", RowsHold::Instants, 2)
    );
    let step = weather.steps[0];
    assert!((step.instant - (instant(2016, 1, 1, 11.0) + 0.1761 * 3600.0)).abs() < 1e-6);
    assert_eq!((step.ghi, step.dni, step.dhi, step.air.temperature), (Some(310.0), Some(520.5), Some(95.0), Some(3.1)));
    assert_eq!((weather.steps[1].month, weather.steps[1].dni), (2, Some(0.0)));
    let older = PVGIS_TYPICAL.replace("Irradiance Time Offset (h): 0.1761\r\n", "");
    assert_eq!(read(&older).unwrap().steps[0].instant, instant(2016, 1, 1, 11.0));
}

const PVGIS_SERIES: &str = "Latitude (decimal degrees):\t45.000\nLongitude (decimal degrees):\t8.000\nElevation (m):\t250\n\
    Radiation database:\tPVGIS-SARAH3\n\n\nSlope: 0 deg. \nAzimuth: 0 deg. \n\
    time,Gb(i),Gd(i),Gr(i),H_sun,T2m,WS10m,Int\n20230601:1110,600.5,120.0,0.0,66.1,24.0,1.1,0.0\n\nGb(i): Beam\n";

#[test]
fn series_of_pvgis_on_a_level_plane_give_global_and_diffuse() {
    let weather = read(PVGIS_SERIES).unwrap();
    let step = weather.steps[0];
    assert_eq!(step.instant, instant(2023, 6, 1, 11.0 + 1.0 / 6.0));
    assert_eq!((step.ghi, step.dni, step.dhi), (Some(720.5), None, Some(120.0)));
    let global = PVGIS_SERIES.replace("Gb(i),Gd(i),Gr(i)", "G(i),A,B");
    assert_eq!((read(&global).unwrap().steps[0].ghi, read(&global).unwrap().steps[0].dhi), (Some(600.5), None));
    let tilted = PVGIS_SERIES.replace("Slope: 0 deg.", "Slope: 35 deg. (optimum)");
    let message = read(&tilted).unwrap_err().to_string();
    assert!(message.contains("35") && message.contains("slope 0"), "{message}");
}

const TMY3: &str = "703165,\"SAND POINT\",AK,-9.0,55.317,-160.517,7\n\
    Date (MM/DD/YYYY),Time (HH:MM),ETR (W/m^2),ETRN (W/m^2),GHI (W/m^2),GHI source,GHI uncert (%),DNI (W/m^2),DHI (W/m^2),Dry-bulb (C)\n\
    01/31/1997,24:00,0,0,0,1,0,0,0,2.0\n06/21/2001,13:00,1100,1330,480,1,9,350,200,11.5\n06/21/2001,14:00,1100,1330,-9900,1,9,350,200,11.5\n\
    06/21/2001,15:00,1100,1330,-9900,1,9,-9900,200,11.5\n";

#[test]
fn hours_of_tmy3_end_in_local_standard_time() {
    let weather = read(TMY3).unwrap();
    assert_eq!((weather.format, weather.steps.len(), weather.left_out_count), ("TMY3", 3, 1));
    // 24:00 of a day whose zone is nine hours behind: the middle of its last hour is 8:30 UTC of the next
    assert_eq!((weather.steps[0].instant, weather.steps[0].month), (instant(1997, 2, 1, 8.5), 1));
    let step = weather.steps[1];
    assert_eq!(
        (step.instant, step.ghi, step.dni, step.dhi),
        (instant(2001, 6, 21, 21.5), Some(480.0), Some(350.0), Some(200.0))
    );
    // what global radiation lacks follows from the others; with diffuse alone nothing does
    let step = weather.steps[2];
    assert_eq!((step.ghi, step.dni, step.dhi), (None, Some(350.0), Some(200.0)));
}

const NSRDB: &str = "Source,Location ID,City,State,Country,Latitude,Longitude,Time Zone,Elevation,Local Time Zone\n\
    NSRDB,335686,-,-,-,40.57,-75.02,-5,90,-5\nYear,Month,Day,Hour,Minute,DHI,DNI,GHI,Temperature\n\
    2017,7,1,12,0,150,700,780,27\n2017,7,1,12,30,160,690,775,27.5\n2017,7,1,13,0,160,680,770,28\n";

#[test]
fn rows_of_nsrdb_are_instants_of_the_zone_in_their_head() {
    let weather = read(NSRDB).unwrap();
    assert_eq!((weather.format, weather.rows_hold), ("NSRDB", RowsHold::Instants));
    let step = weather.steps[1];
    assert_eq!((step.instant, step.hours), (instant(2017, 7, 1, 17.5), 0.5));
    assert_eq!(
        (step.ghi, step.dni, step.dhi, step.air.temperature),
        (Some(775.0), Some(690.0), Some(160.0), Some(27.5))
    );
    assert!((weather.hours() - 1.5).abs() < 1e-12);
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    let row = epw_row("1999,6,21,13,60", "800", "700", "150");
    let cases: Vec<(String, &[&str])> = vec![
        ("x,y,z\n1,2,3\n".to_owned(), &["not a known weather file", "EPW"]),
        (String::new(), &["not a known weather file"]),
        (epw(""), &["no row"]),
        (epw(&row.replace("800", "hot")), &["line 9", "global", "hot"]),
        (epw(&row.replace("800", "NaN")), &["line 9", "NaN"]),
        (epw(&row.replace("800", "1e308")), &["line 9", "3000"]),
        // what spreadsheets make of numbers where commas are decimal
        (epw(&row.replace("10.5", "10,5")) + &row, &["line 10", "cells", "decimal commas"]),
        (epw(&row).replace("52.3,4.77", "52,3,4,77"), &["line 1", "12 cells", "decimal commas"]),
        (epw(&format!("{}{}", row.trim_end(), ",0".repeat(20))), &["line 9", "decimal commas"]),
        (epw(&row).replace(',', ";"), &["semicolons"]),
        (NSRDB.replace("27.5", "27,5"), &["line 5", "decimal commas"]),
        (PVGIS_TYPICAL.replace("310.0,520.5", "310,0,520,5"), &["line 9", "decimal commas"]),
        (epw(&row.replace("800", "5000")), &["line 9", "5000", "3000"]),
        (epw(&row.replace("800", "-300")), &["line 9", "-300"]),
        (epw(&row.replace("1999,6,21", "1999,2,30")), &["line 9", "1999-02-30"]),
        (epw(&row.replace(",13,60", ",25,60")), &["line 9", "hour 25"]),
        (epw("1999,6,21,13\n"), &["line 9", "cell 5"]),
        (epw(&row).replace("DATA PERIODS", "DATA"), &["line 8", "DATA PERIODS"]),
        (epw(&row).replace("52.3", "152.3"), &["latitude"]),
        (epw(&row).replace("52.3", "north"), &["line 1", "latitude", "north"]),
        ("LOCATION,a,b,c,d,e,1,2,3,4\n".to_owned(), &["ends before line 8"]),
        (PVGIS_TYPICAL.replace("20160101:1100", "2016-01-01 11:00"), &["line 9", "20200131:0010"]),
        (PVGIS_TYPICAL.replace("20160101:1100", "20160101:2500"), &["line 9", "25"]),
        (PVGIS_TYPICAL.replace("time(UTC)", "zeit"), &["time"]),
        (PVGIS_TYPICAL.replace("Latitude (decimal degrees): 45.000", "Latitude: 45"), &["Latitude (decimal degrees)"]),
        (PVGIS_TYPICAL.replace("0.1761", "12"), &["line 4", "offset"]),
        (PVGIS_TYPICAL.replace("310.0,520.5", "310.0"), &["line 9"]),
        (PVGIS_SERIES.replace("Gb(i),Gd(i),Gr(i)", "P,Q,R"), &["no radiation"]),
        (TMY3.replace("GHI (W/m^2)", "Global"), &["line 2", "GHI (W/m^2)"]),
        (TMY3.replace("06/21/2001,13:00", "21.06.2001,13:00"), &["line 4", "MM/DD/YYYY"]),
        (NSRDB.replace("Latitude", "Breite"), &["line 2", "Latitude"]),
        (NSRDB.replace("2017,7,1,12,30", "2017,7,1,12,75"), &["line 5", "75"]),
    ];
    for (text, words) in cases {
        let message = read(&text).unwrap_err().to_string();
        assert!(message.contains("weather.file"), "{message}");
        for word in words {
            assert!(message.contains(word), "{word} is not in: {message}");
        }
    }
    assert!(read_weather(std::path::Path::new("/nowhere/at.epw")).is_err());
}

#[test]
fn what_a_row_lacks_follows_from_the_rest_of_it() {
    let rows: String = (10..15_u8)
        .map(|hour| {
            let (ghi, dni, dhi) = match hour {
                10 => ("9999", "700", "150"),
                11 => ("99999", "700", "150"),
                12 => ("800", "9999", "150"),
                13 => ("800", "700", "999900"),
                _ => ("-999", "9999", "150"),
            };
            epw_row(&format!("1999,6,21,{hour},60"), ghi, dni, dhi)
        })
        .collect();
    let weather = read(&epw(&rows)).unwrap();
    assert_eq!((weather.steps.len(), weather.left_out_count), (4, 1));
    assert_eq!(weather.notes.len(), 3, "{:?}", weather.notes);
    assert!(weather.notes[0].starts_with("2 of 4 rows have no global radiation"), "{:?}", weather.notes);
    let site = Site { latitude: weather.latitude, longitude: weather.longitude, height: 0.0, convergence: 0.0 };
    let instants = weather_instants(&weather, &site, 1).unwrap();
    for instant in &instants[..2] {
        let expected = 700.0 * instant.zenith.cos() + 150.0;
        assert!((instant.irradiance.ghi - expected).abs() < 1e-9, "{instant:?}");
    }
    assert!((instants[2].irradiance.dni - 650.0 / instants[2].zenith.cos()).abs() < 1e-9);
    assert!((instants[3].irradiance.dhi - (800.0 - 700.0 * instants[3].zenith.cos())).abs() < 1e-9);
}

#[test]
fn weather_in_utf_16_is_read() {
    let bytes: Vec<u8> = format!("\u{feff}{NSRDB}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    let weather = read_weather(belvedere::io::Source::bytes("a.csv", &bytes)).unwrap();
    assert_eq!(weather, read(NSRDB).unwrap());
}
