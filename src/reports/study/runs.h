// Runs the settings of a study: those of the sweeps at every receiver, and all of them at the chosen receivers.
#pragma once

#include <span>

#include "exactff/study.h"
#include "jobs/kept_work.h"
#include "study/prepared_method.h"

namespace exactff::study {

// Fills in Study::judged, samples, and the values, statistics and slopes of methods. `study` must have its exact
// values, and the settings and cells that plan_runs() leaves.
void run_settings(Study& study, std::span<const ExactSource> sources, PreparedMethods& methods,
                  const jobs::KeptWork& kept, const Hooks& hooks);

}  // namespace exactff::study
