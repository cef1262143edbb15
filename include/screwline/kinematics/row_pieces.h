#ifndef SCREWLINE_KINEMATICS_ROW_PIECES_H
#define SCREWLINE_KINEMATICS_ROW_PIECES_H

#include <cstddef>
#include <functional>

namespace screwline {

/// How the rows of a batch are shared out.
struct RowPieces {
  std::size_t count = 0;         ///< Rows.
  std::size_t rows = 1;          ///< Of a piece; the last may have fewer.
  std::size_t least_pieces = 1;  ///< That are worth a thread's start.
  int threads = 1;               ///< At most, the caller's included; 0: as many as cores.
};

/// Calls work(first, last) for each piece, each once, from several threads, and returns when all are done. `stop` (may
/// be empty) is asked before each piece of the calling thread, by it alone; true: no further piece is begun, and the
/// answer is false. What `work` throws is thrown here, once the other threads have ended. Where no further thread can
/// be started, those that there are do the work. With one thread, nothing is allocated.
bool forPieces(const RowPieces& pieces, const std::function<bool()>& stop,
               const std::function<void(std::size_t, std::size_t)>& work);

}  // namespace screwline

#endif  // SCREWLINE_KINEMATICS_ROW_PIECES_H
