// SPDX-License-Identifier: Apache-2.0
// The tables of kerf.db: making them, checking a file that claims to have them, rows in and out. Internal to
// model.
#pragma once

#include <vector>

#include "burin/base/result.h"
#include "burin/model/kerf.h"
#include "burin/model/kerf_runs.h"
#include "burin/model/sqlite.h"

namespace burin::model {

/// Makes the tables and fills in the built-in kerf table. To be called inside a transaction.
Result<void> create_schema(const sqlite::Connection& connection);

/// True for a file without any content yet.
Result<bool> is_blank(const sqlite::Connection& connection);

/// Errors (data): not a kerf database, newer schema, damaged, foreign triggers or views.
Result<void> check_schema(const sqlite::Connection& connection, const std::string& path);

/// All models sorted by laser, material, thickness, version. Each is checked against the checksum written
/// with it, so that a flipped bit in a coefficient is an error (data) and not a wrong kerf.
Result<std::vector<KerfModel>> load_models(const sqlite::Connection& connection, const std::string& path);

/// Adds the model with the next version of its laser, material and thickness, its permissible table and all
/// its runs; sets fit.model.version. To be called inside a transaction.
Result<void> store_fit(const sqlite::Connection& connection, KerfFit& fit);

}  // namespace burin::model
