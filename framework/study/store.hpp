#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "butee/record/folder_lock.hpp"
#include "butee/study/row_file.hpp"
#include "butee/study/rows.hpp"
#include "butee/study/study.hpp"

namespace butee::study {

/// The identity of a study, as texts that are compared before it is continued: the scene with the
/// files that it names, the plan and the collected items, and the build.
struct Identity {
  std::string study, scene, build;
  bool operator==(const Identity&) const = default;
};
BUTEE_EXPORT Identity identity_of(const Study& study);

/// The folder of a study.
///
///     study.toml             the study with its scene as run, and its identity
///     rows-S-K.h5 (.csv)     rows in the order of completion: session S, process K
///     sweep-C.bin            the state of sweep C while it is running
///     study.h5 (.csv)        all rows in the order of the plan, once complete; replaces the
///     row files
///     shard-I-of-N/          the same files for one shard
class BUTEE_EXPORT Store final : public Rows {
 public:
  /// `study`, `layout` and `format` must outlive this object. Accesses no files.
  Store(std::string folder, const Study& study, const Layout& layout, RowFormat& format);
  ~Store() override;

  /// Throws InputError if a folder is neither empty nor that of a study or its shards.
  static void refuse_foreign(const std::string& folder);

  /// Creates the folder if it is missing, locks it for writing and finds the completed runs. With
  /// `fresh` the files of an earlier study are removed. Throws InputError if the folder does not
  /// belong to a study, another process writes there, or its content is of another scene, study or
  /// build; RunError if it cannot be written.
  void open(bool fresh);
  /// Finds the completed runs, for a process other than the one that opened the folder.
  void look();

  bool is_complete() const { return is_complete_; }
  bool is_done(std::int64_t run) const override { return done_[static_cast<std::size_t>(run)]; }
  std::int64_t done_count() const override { return done_count_; }

  /// Creates a file for the rows of this process; session and process must be unique.
  void begin(int session, int process);
  int next_session() const { return next_session_; }
  /// Rows are buffered for some tenths of a second at most.
  void append(const Row& row) override;
  void flush() override;

  void keep(std::int64_t chain, std::int64_t run, const Motion& motion) override;
  std::int64_t kept(std::int64_t chain, Motion& motion) const override;
  void forget(std::int64_t chain) override;

  /// Sorts the rows of all files of this folder, and of its shards, into study.h5 or study.csv, and
  /// removes the row files. False if rows are missing; `missing` is then the first of them.
  bool merge(std::int64_t& missing);

  /// Calls `look(row)` for all existing rows, in the order of the plan.
  void visit(const std::function<void(const Row&)>& look) const;

  /// Accepts the content of the folder even if the study has changed since: for viewing, not for
  /// continuing.
  void adopt_identity();

  /// True for the folder of a study.
  static bool is_study_folder(const std::string& folder);
  /// The folder with the study as run: `folder` or, before its shards are merged, the first of
  /// them; "" if there is none.
  static std::string study_in(const std::string& folder);
  /// The study of a folder, as it was run. Throws InputError.
  static Study read(const std::string& folder);
  /// The extension of its row files.
  static std::string extension_in(const std::string& folder);

  /// Counts of rows by status for the final message: completed, failed and refused, and the first
  /// reason.
  struct Count {
    std::int64_t completed = 0, failed = 0;
    std::string first_reason;
  };
  Count count() const;

  /// The prefix of the names of sweep files, and the file with the study as run.
  static constexpr const char* kSweep = "sweep-";
  static constexpr const char* kStudyFile = "study.toml";

  const std::string& folder() const { return folder_; }
  std::string file(const std::string& name) const;
  /// study.h5 or study.csv
  std::string result() const;

 private:
  struct Found;

  /// True for the name of a file of rows, of a finished study or of one that goes on.
  static bool is_row_file(const std::string& name);
  std::vector<std::string> row_files(const std::string& folder) const;
  /// The row files of this folder and of its shards.
  std::vector<std::string> all_row_files() const;
  /// Calls `look` for the rows of the files.
  void visit_files(const std::vector<std::string>& files,
                   const std::function<void(std::size_t file, std::int64_t index, std::int64_t run)>& look) const;
  /// The location of the row of each run, if it exists.
  Found find_rows() const;
  /// Calls `look` with blocks of whole rows in the order of the runs.
  void visit_in_order(const Found& found, const std::function<void(std::span<const std::byte> rows)>& look) const;
  /// Removes shards and sweep files.
  void remove_parts() const;
  /// Opens a row file of this study; a damaged one counts as empty, with a warning. Throws RunError if it cannot be
  /// opened.
  std::unique_ptr<RowSource> open_rows(const std::string& path) const;
  void check_identity(const std::string& folder) const;
  void read_done();
  void clear() const;

  std::string folder_;
  const Study& study_;
  const Layout& layout_;
  RowFormat& format_;
  Identity identity_;
  std::unique_ptr<record::FolderLock> lock_;
  std::vector<bool> done_;
  std::int64_t done_count_ = 0;
  int next_session_ = 0;
  bool is_complete_ = false;

  std::mutex mutex_;
  std::unique_ptr<RowSink> sink_;
  std::vector<std::byte> waiting_;
  std::chrono::steady_clock::time_point flushed_;
};

}  // namespace butee::study
