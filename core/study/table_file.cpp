#include "study/table_file.h"

#include <hdf5.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <map>

#include "weft/estimate.h"

namespace weft {

namespace {

// An identifier of HDF5, closed at the end.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id < 0) throw std::runtime_error("HDF5 refused");
  }
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  Id& operator=(Id&&) = delete;
  operator hid_t() const { return id_; }
  void close() { check(close_(std::exchange(id_, -1))); }
  static void check(herr_t result) {
    if (result < 0) throw std::runtime_error("HDF5 refused");
  }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// HDF5 says nothing itself, and writes nothing at the end of the program, where a full disk would make it
// try again.
void quiet() {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Id text_type(std::size_t bytes) {
  Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  Id::check(H5Tset_size(type, bytes));
  Id::check(H5Tset_strpad(type, H5T_STR_NULLPAD));
  Id::check(H5Tset_cset(type, H5T_CSET_UTF8));
  return type;
}

Id row_type(const Study& study) {
  Id row(H5Tcreate(H5T_COMPOUND, study.row_bytes()), H5Tclose);
  for (const Column& c : study.columns()) {
    const Id text = text_type(c.bytes);
    const hid_t type = c.kind == Column::Kind::text    ? hid_t(text)
                       : c.kind == Column::Kind::whole ? H5T_NATIVE_UINT64
                                                       : H5T_NATIVE_DOUBLE;
    Id::check(H5Tinsert(row, c.name.c_str(), c.offset, type));
  }
  return row;
}

Id space_of(const std::vector<hsize_t>& sizes) {
  return {H5Screate_simple(int(sizes.size()), sizes.data(), nullptr), H5Sclose};
}

Id properties(hid_t kind) {
  Id list(H5Pcreate(kind), H5Pclose);
  Id::check(H5Pset_obj_track_times(list, false));  // equal results are equal bytes
  return list;
}

void write_values(hid_t file, const char* name, hid_t type, const std::vector<hsize_t>& sizes,
                  const void* values) {
  const Id space = space_of(sizes);
  Id set(
      H5Dcreate2(file, name, type, space, H5P_DEFAULT, properties(H5P_DATASET_CREATE), H5P_DEFAULT),
      H5Dclose);
  if (sizes[0] > 0) Id::check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  set.close();
}

// A text of any length; long ones are no attributes.
void write_text(hid_t file, const char* name, const std::string& text) {
  const Id type = text_type(std::max<std::size_t>(text.size(), 1));
  const Id space(H5Screate(H5S_SCALAR), H5Sclose);
  Id set(
      H5Dcreate2(file, name, type, space, H5P_DEFAULT, properties(H5P_DATASET_CREATE), H5P_DEFAULT),
      H5Dclose);
  Id::check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()));
  set.close();
}

std::array<hsize_t, 4> chunk_shape(const Chunks& chunks) {
  return {1, chunks.samples, chunks.particles, 3};
}

Id create_positions(hid_t file, const Chunks& chunks, std::size_t runs, std::uint64_t particles) {
  const Id list = properties(H5P_DATASET_CREATE);
  Id::check(H5Pset_chunk(list, 4, chunk_shape(chunks).data()));
  Id::check(H5Pset_shuffle(list));
  Id::check(H5Pset_deflate(list, 1));
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  Id::check(H5Pset_fill_value(list, H5T_NATIVE_FLOAT, &nothing));
  const Id space = space_of({runs, chunks.frames.size(), particles, 3});
  return {H5Dcreate2(file, "positions", H5T_IEEE_F32LE, space, H5P_DEFAULT, list, H5P_DEFAULT),
          H5Dclose};
}

void write_chunks(hid_t positions, const Chunks& chunks, std::size_t row, const Record& record) {
  for (const Record::Chunk& c : record.chunks) {
    const std::array<hsize_t, 4> at{row, c.sample * chunks.samples, c.particle * chunks.particles,
                                    0};
    Id::check(H5Dwrite_chunk(positions, H5P_DEFAULT, 0, at.data(), c.bytes.size(), c.bytes.data()));
  }
}

void write_all(const std::string& path, const Study& study, Shard shard,
               const std::vector<Stored>& records) {
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  Id::check(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110));
  const Id list = properties(H5P_FILE_CREATE);
  Id file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, list, access), H5Fclose);
  const Chunks& chunks = study.chunks();
  std::uint64_t particles = chunks.particles;
  for (const Stored& s : records) particles = std::max(particles, s.particles);

  std::string rows;
  {
    std::optional<Id> positions;
    if (!chunks.frames.empty())
      positions.emplace(create_positions(file, chunks, records.size(), particles));
    for (std::size_t k = 0; k < records.size(); ++k) {
      const Record record = records[k].read();
      rows += record.row;
      if (positions) write_chunks(*positions, chunks, k, record);
    }
    if (positions) positions->close();
  }
  write_values(file, "runs", row_type(study), {records.size()}, rows.data());
  if (!chunks.frames.empty())
    write_values(file, "frames", H5T_NATIVE_INT64, {chunks.frames.size()}, chunks.frames.data());
  write_values(file, "triangles", H5T_NATIVE_UINT32, {study.triangles().size() / 3, 3},
               study.triangles().data());
  write_text(file, "study", study.text());
  const std::array<std::uint64_t, 2> which{shard.number, shard.of};
  write_values(file, "shard", H5T_NATIVE_UINT64, {2}, which.data());
  Id::check(H5Fflush(file, H5F_SCOPE_GLOBAL));
  file.close();
}

// A disk that is too full is found before HDF5 begins, which has no good way out of it.
void require_room(const OutputFile& file, const std::vector<Stored>& records) {
  double bytes = 1 << 20;
  for (const Stored& s : records) bytes += double(s.bytes) + 256;
  struct statvfs disk {};
  if (::statvfs(file.temporary().c_str(), &disk) != 0) return;
  const double free = double(disk.f_bavail) * double(disk.f_frsize);
  if (free < bytes)
    throw WriteError(file.path(), "the file takes about " + bytes_words(bytes) +
                                      ", and the disk has " + bytes_words(free) + " left");
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw StudyError({{path, why, "a file that `weft study` wrote"}});
}

}  // namespace

void write_table(OutputFile& file, const Study& study, Shard shard,
                 const std::vector<Stored>& records) {
  quiet();
  require_room(file, records);
  try {
    write_all(file.temporary(), study, shard, records);
  } catch (const std::runtime_error& error) {
    throw WriteError(file.path(), std::string("writing failed: ") + error.what());
  }
}

struct TableFile::Handle {
  Id file;
};

TableFile::TableFile(const std::string& path) : path_(path) {
  quiet();
  if (!std::filesystem::exists(path)) refuse(path, "there is no such file");
  try {
    handle_ = std::make_unique<Handle>(
        Handle{{H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose}});
    const Id study(H5Dopen2(handle_->file, "study", H5P_DEFAULT), H5Dclose);
    const Id type(H5Dget_type(study), H5Tclose);
    study_.resize(H5Tget_size(type));
    Id::check(H5Dread(study, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, study_.data()));
    const Id shard(H5Dopen2(handle_->file, "shard", H5P_DEFAULT), H5Dclose);
    std::array<std::uint64_t, 2> which{};
    Id::check(H5Dread(shard, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, which.data()));
    shard_ = {which[0], which[1]};
  } catch (const std::runtime_error&) {
    refuse(path, "it cannot be read as the results of a study");
  }
  if (shard_.of == 0 || shard_.number >= shard_.of) refuse(path, "its shard is out of range");
}
TableFile::~TableFile() = default;
TableFile::TableFile(TableFile&&) noexcept = default;

namespace {

Record read_record(hid_t file, const Study& study, std::size_t row, const std::string& bytes) {
  Record record;
  record.row = bytes;
  std::copy_n(bytes.data(), 8, reinterpret_cast<char*>(&record.run));
  std::copy_n(bytes.data() + 8, 8, reinterpret_cast<char*>(&record.particles));
  const Chunks& chunks = study.chunks();
  if (chunks.frames.empty()) return record;
  const Id positions(H5Dopen2(file, "positions", H5P_DEFAULT), H5Dclose);
  const std::size_t across = (record.particles + chunks.particles - 1) / chunks.particles;
  for (std::size_t s = 0; s * chunks.samples < chunks.frames.size(); ++s)
    for (std::size_t p = 0; p < across; ++p) {
      const std::array<hsize_t, 4> at{row, s * chunks.samples, p * chunks.particles, 0};
      hsize_t size = 0;
      // A run that stopped itself has no chunks from then on.
      if (H5Dget_chunk_storage_size(positions, at.data(), &size) < 0 || size == 0) continue;
      Record::Chunk chunk{std::uint32_t(s), std::uint32_t(p), std::string(size, '\0')};
      std::uint32_t filters = 0;
      Id::check(H5Dread_chunk(positions, H5P_DEFAULT, at.data(), &filters, chunk.bytes.data()));
      record.chunks.push_back(std::move(chunk));
    }
  return record;
}

}  // namespace

std::vector<Stored> TableFile::records(const Study& study) const {
  std::vector<Stored> all;
  const hid_t file = handle_->file;
  try {
    const Id set(H5Dopen2(file, "runs", H5P_DEFAULT), H5Dclose);
    const Id space(H5Dget_space(set), H5Sclose), stored(H5Dget_type(set), H5Tclose),
        type = row_type(study);
    const hssize_t rows = H5Sget_simple_extent_npoints(space);
    const std::size_t size = study.row_bytes();
    if (rows < 0 || H5Tequal(stored, type) <= 0) refuse(path_, "its table is of another study");
    std::string bytes(std::size_t(rows) * size, '\0');
    if (rows > 0) Id::check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()));
    for (std::size_t k = 0; k < std::size_t(rows); ++k) {
      const std::string row = bytes.substr(k * size, size);
      Stored s;
      std::copy_n(row.data(), 8, reinterpret_cast<char*>(&s.run));
      std::copy_n(row.data() + 8, 8, reinterpret_cast<char*>(&s.particles));
      s.bytes = size;
      s.read = [file, &study, k, row, path = path_] {
        try {
          return read_record(file, study, k, row);
        } catch (const std::runtime_error&) {
          refuse(path, "its positions cannot be read");
        }
      };
      all.push_back(std::move(s));
    }
  } catch (const std::runtime_error&) {
    refuse(path_, "its table cannot be read");
  }
  return all;
}

}  // namespace weft
