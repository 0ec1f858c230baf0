// SPDX-License-Identifier: Apache-2.0
// Records in a canonical form that dxflib reads without reaching its weak spots: only the groups that matter,
// counts in front and true, numbers checked, short lines, no comments.
#pragma once

#include <streambuf>
#include <string>
#include <vector>

#include "burin/base/result.h"
#include "burin/io/dxf/document.h"

namespace burin::io::dxf {

/// The canonical text of one record, with what had to be put right.
struct FedRecord {
  std::string text;
  std::vector<std::string> repairs;
};

/// Empty text: nothing in the record is for dxflib. Errors (syntax): a value that is not a number, a name too
/// long.
Result<FedRecord> feed_record(const Document& document, const Record& record, const std::string& file);

/// Text of the last tag of the record with this code, without surrounding blanks; "" when there is none.
std::string_view text_of(const Document& document, const Record& record, int code);
/// The same as integer; `fallback` when there is none or it is no integer.
int int_of(const Document& document, const Record& record, int code, int fallback);

/// The stream that dxflib reads: one record after the other, never all in memory.
class FeedBuffer : public std::streambuf {
 public:
  FeedBuffer(const Document& document, const std::string& file) : document_(document), file_(file) {}

  /// Indices of the records that were handed out, in order.
  const std::vector<std::size_t>& fed() const { return fed_; }
  struct Repair {
    std::size_t record;
    std::string what;
  };
  const std::vector<Repair>& repairs() const { return repairs_; }
  /// The error that ended the stream early; ErrorCode::internal with empty message: none.
  const Error& error() const { return error_; }
  bool failed() const { return !error_.message.empty(); }

 protected:
  int_type underflow() override;

 private:
  const Document& document_;
  const std::string& file_;
  std::size_t next_ = 0;
  bool ended_ = false;
  std::string text_;
  std::vector<std::size_t> fed_;
  std::vector<Repair> repairs_;
  Error error_;
};

}  // namespace burin::io::dxf
