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

/// What a study is made of, as texts that are compared before it goes on: the scene with the files that it names, the
/// plan and what is collected, and the build.
struct Identity {
  std::string study, scene, build;
  bool operator==(const Identity&) const = default;
};
BUTEE_EXPORT Identity identity_of(const Study& study);

/// The folder of a study.
///
///     study.toml             the study with its scene as run, and its identity
///     rows-S-K.h5 (.csv)     rows in the order in which they were done: session S, process K
///     sweep-C.bin            where sweep C stands, while it is under way
///     study.h5 (.csv)        all rows in the order of the plan, once they are there; the files of rows are gone then
///     shard-I-of-N/          the same of one shard
class BUTEE_EXPORT Store final : public Rows {
 public:
  /// `study`, `layout` and `format` must outlive it. Touches nothing.
  Store(std::string folder, const Study& study, const Layout& layout, RowFormat& format);
  ~Store() override;

  /// Throws InputError where a folder is neither empty nor one of a study or its shards.
  static void refuse_foreign(const std::string& folder);

  /// Makes the folder where it is missing, takes the right to write there and looks at what is done. With `fresh` what
  /// is there of an earlier study is taken away. Throws InputError where the folder is not ours, another process
  /// writes there, or what it holds is of another scene, study or build; RunError where it cannot be written.
  void open(bool fresh);
  /// Looks at what is done, for a process beside that which has opened it.
  void look();

  bool is_complete() const { return is_complete_; }
  bool is_done(std::int64_t run) const override { return done_[static_cast<std::size_t>(run)]; }
  std::int64_t done_count() const override { return done_count_; }

  /// Begins a file for the rows of this process; no two give the same session and process.
  void begin(int session, int process);
  int next_session() const { return next_session_; }
  /// Rows wait for each other some tenths of a second at most.
  void append(const Row& row) override;
  void flush() override;

  void keep(std::int64_t chain, std::int64_t run, const Motion& motion) override;
  std::int64_t kept(std::int64_t chain, Motion& motion) const override;
  void forget(std::int64_t chain) override;

  /// Sorts the rows of all files of this folder, and of those of its shards, into study.h5 or study.csv, and takes the
  /// files of rows away. False where rows are missing, of which `missing` is the first.
  bool merge(std::int64_t& missing);

  /// Calls `look(row)` for all rows that are there, in the order of the plan.
  void visit(const std::function<void(const Row&)>& look) const;

  /// Takes what is in the folder for its own, whatever has changed since: to look at, not to go on with.
  void adopt_identity();

  /// True for the folder of a study.
  static bool is_study_folder(const std::string& folder);
  /// The folder with the study as run: `folder` or, before its shards are merged, the first of them; "" where it holds
  /// none.
  static std::string study_in(const std::string& folder);
  /// The study of a folder, as it was run. Throws InputError.
  static Study read(const std::string& folder);
  /// The extension of its files of rows.
  static std::string extension_in(const std::string& folder);

  /// Rows by status, for what is said at the end: completed, failed and refused, and the first reason.
  struct Count {
    std::int64_t completed = 0, failed = 0;
    std::string first_reason;
  };
  Count count() const;

  /// What the names of files of sweeps begin with, and the file with the study as run.
  static constexpr const char* kSweep = "sweep-";
  static constexpr const char* kStudyFile = "study.toml";

  const std::string& folder() const { return folder_; }
  std::string file(const std::string& name) const;
  /// study.h5 or study.csv
  std::string result() const;

 private:
  struct Found;

  std::vector<std::string> row_files(const std::string& folder) const;
  /// Those of this folder and of its shards.
  std::vector<std::string> all_row_files() const;
  /// The place of the row of each run, where there is one.
  Found find_rows(const std::vector<std::string>& files) const;
  /// Takes away shards and what sweeps have kept.
  void remove_parts() const;
  /// A file of rows of this study; one that cannot be read has none, with a warning.
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
