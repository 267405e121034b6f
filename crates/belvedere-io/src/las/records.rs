//! Contents of LAS files beside the attributes of a cloud, and selection of the records that a copy of their points
//! keeps.

use ::las::Vlr;
use ::las::point::Format;

use crate::las::extra::descriptions;
use crate::las::header::{LasHeader, VariableRecord};

/// The user of records about reference systems.
const PROJECTION: &str = "LASF_Projection";
/// The user of records that the format defines.
const SPECIFICATION: &str = "LASF_Spec";
/// The user and the number of the record that names the columns of results that Belvedere wrote.
pub(crate) const RESULTS: (&str, u16) = ("belvedere", 2);

/// Returns the attributes of the points of a file beside those of a cloud and rare fields, in words.
pub(crate) fn other_attributes(header: &LasHeader, format: &Format) -> Vec<String> {
    let described = descriptions(header, format);
    let described_bytes: usize = described.iter().map(|field| field.size).sum();
    let names = described.iter().map(|field| field.name());
    let mut found: Vec<String> = names.filter(|name| !name.starts_with("Normal")).collect();
    if usize::from(format.extra_bytes) > described_bytes {
        found.push(format!("{} extra bytes without a description", usize::from(format.extra_bytes) - described_bytes));
    }
    found.extend(format.has_nir.then(|| "near infrared".to_owned()));
    found.extend(format.has_waveform.then(|| "waveforms".to_owned()));
    found
}

/// Returns true if a record is about the reference system.
pub(crate) fn is_projection(record: &VariableRecord) -> bool {
    record.user == PROJECTION || record.user == "liblas" && record.id == 2112
}

/// Returns the records that a copy of all points keeps. Records of the compression, of extra bytes and results are made
/// anew. Records of waveforms, of the hierarchy of COPC, and of reference systems are dropped.
pub(crate) fn kept_records(header: &LasHeader) -> impl Iterator<Item = &VariableRecord> {
    let is_made_anew = |record: &VariableRecord| {
        let key = (record.user.as_str(), record.id);
        key == ("laszip encoded", 22204) || key == (SPECIFICATION, 4) || key == RESULTS
    };
    header.records.iter().filter(move |record| {
        !is_made_anew(record) && !is_projection(record) && !is_of_waveforms(record) && record.user != "copc"
    })
}

/// Returns true if a record describes or holds waveforms.
fn is_of_waveforms(record: &VariableRecord) -> bool {
    record.user == SPECIFICATION && (matches!(record.id, 100..=354) || record.id == 65535)
}

/// Name of a record.
pub(crate) fn in_words(record: &VariableRecord) -> String {
    format!("the record {} of {}", record.id, record.user)
}

/// A record as it is written. Its texts have 16 and 32 bytes of ASCII.
pub(crate) fn to_vlr(record: &VariableRecord) -> Vlr {
    let ascii = |text: &str, length: usize| -> String {
        text.chars().map(|c| if c.is_ascii() { c } else { '?' }).take(length).collect()
    };
    Vlr {
        user_id: ascii(&record.user, 16),
        record_id: record.id,
        description: ascii(&record.description, 32),
        data: record.data.clone(),
    }
}
