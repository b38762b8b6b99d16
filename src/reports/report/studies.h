// Reports read studies, and use their names without the namespace.
#pragma once

#include "exactff/study.h"

namespace exactff::report {

using study::ErrorStatistics;
using study::ExactRow;
using study::ExactTerm;
using study::Ladder;
using study::MethodCell;
using study::MethodField;
using study::MethodStudy;
using study::Profile;
using study::SampleRow;
using study::Sight;
using study::Slope;
using study::Study;
using study::Summary;
using study::Sweeps;
using study::TimeSummary;

}  // namespace exactff::report
