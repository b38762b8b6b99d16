// The parts of a study that reports read.
#pragma once

#include "exactff/study.h"

namespace exactff::report {

using study::ErrorStatistics;
using study::ExactRow;
using study::ExactTerm;
using study::kNotTimed;
using study::Ladder;
using study::LadderSlopes;
using study::MethodCell;
using study::MethodField;
using study::MethodStudy;
using study::name_of;
using study::Parameter;
using study::Profile;
using study::Request;
using study::SampleRow;
using study::Sight;
using study::Slope;
using study::Study;
using study::Summary;
using study::Sweeps;
using study::TimeSummary;

}  // namespace exactff::report
