// Writes movies: pipes frames into ffmpeg.
//
// ffmpeg reads from a socket instead of a pipe: a write to a pipe whose reader
// has died would kill the program, but a socket reports an error. ffmpeg writes
// a temporary file next to the movie, which is renamed when it is complete.
#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <system_error>
#include <utility>

#include "io/atomic_file.h"
#include "pliant/error.h"
#include "render.h"

extern char** environ;

namespace pliant::render {

struct MovieWriter::Implementation {
  std::string path, temporary, words_path;
  std::size_t frame_size = 0;
  int socket = -1, words = -1;  // file descriptors: to send frames, and to receive messages
  pid_t process = -1;
  bool finished = false;

  [[noreturn]] void fail(const std::string& problem, const std::string& advice = {}) const {
    throw Error({.file = path, .line = 0, .object = {}, .element = {}}, problem, advice);
  }

  /// Makes an empty file next to the movie. Returns its name.
  std::string make_beside(int& descriptor) const {
    const std::size_t slash = path.rfind('/');
    std::string name = (slash == std::string::npos ? "" : path.substr(0, slash + 1)) + ".pliant-movie-XXXXXX";
    descriptor = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor < 0)
      fail("cannot write: " + std::generic_category().message(errno),
           "check that its folder exists, is writable and has space");
    return name;
  }

  void start(int width, int height, double rate) {
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
      fail("cannot write: it is not a regular file", "name a file");
    int descriptor = -1;
    temporary = make_beside(descriptor);
    remember_unfinished(temporary.c_str());
    ::fchmod(descriptor, 0644);
    ::close(descriptor);
    const std::string name = make_beside(words);
    ::unlink(name.c_str());
    std::array<int, 2> ends{-1, -1};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
      fail("cannot create a socket to ffmpeg");
    socket = ends[0];
    const int code = spawn(ends[1], width, height, rate);
    ::close(ends[1]);
    if (code != 0)
      fail("movies need the program ffmpeg, which cannot be started: " + std::generic_category().message(code),
           "install the Debian package ffmpeg");
  }

  int spawn(int input, int width, int height, double rate) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height), frames = std::to_string(rate);
    const std::vector<std::string> words_of_command{
        "ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y", "-f", "rawvideo", "-pixel_format", "rgb24",
        "-video_size", size, "-framerate", frames, "-i", "pipe:0", "-an", "-vf",
        // H.264 with fewer samples of colour needs even sizes, and players assume the colour space BT.709.
        "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv", "-c:v", "libx264", "-preset",
        "medium", "-crf", "17", "-pix_fmt", "yuv420p", "-colorspace", "bt709", "-color_primaries", "bt709",
        "-color_trc", "bt709", "-color_range", "tv", "-movflags", "+faststart", "-f", "mp4", "file:" + temporary};
    std::vector<char*> arguments;
    for (const std::string& word : words_of_command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, 0);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, words, 2);
    // ffmpeg gets a process group of its own. A terminal's interrupt then reaches only this program, which can finish
    // the movie properly.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int code = ::posix_spawnp(&process, "ffmpeg", &actions, &attributes, arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (code != 0) process = -1;
    return code;
  }

  /// Waits until ffmpeg exits. Returns true on success.
  bool wait() {
    if (socket >= 0) ::close(std::exchange(socket, -1));
    if (process < 0) return false;
    int status = 0;
    while (::waitpid(process, &status, 0) < 0) {
      if (errno != EINTR) return false;
    }
    process = -1;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

  std::string complaint() const {
    std::array<char, 600> text{};
    const ssize_t size = words < 0 ? 0 : ::pread(words, text.data(), text.size(), 0);
    std::string result(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
    while (!result.empty() && (result.back() == '\n' || result.back() == ' ')) result.pop_back();
    return result.empty() ? "ffmpeg failed without a message" : "ffmpeg failed: " + result;
  }

  void send_all(const std::uint8_t* bytes, std::size_t count) {
    while (count > 0) {
      const ssize_t done = ::send(socket, bytes, count, MSG_NOSIGNAL);
      if (done < 0 && errno == EINTR) continue;
      if (done <= 0) {
        wait();
        fail(complaint(), "check the space on the disk");
      }
      bytes += done;
      count -= static_cast<std::size_t>(done);
    }
  }

  ~Implementation() {
    if (process >= 0) ::kill(process, SIGKILL);
    wait();
    if (words >= 0) ::close(words);
    if (temporary.empty()) return;
    ::unlink(temporary.c_str());
    forget_unfinished(temporary.c_str());
  }
};

MovieWriter::MovieWriter(std::string path, int width, int height, double frames_per_second)
    : self_(std::make_unique<Implementation>()) {
  self_->path = std::move(path);
  if (!(frames_per_second >= 1 && frames_per_second <= 240)) self_->fail("a movie has 1 to 240 frames a second");
  if (width <= 0 || height <= 0) self_->fail("a movie needs a width and a height");
  self_->frame_size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3;
  self_->start(width, height, frames_per_second);
}

MovieWriter::~MovieWriter() = default;
MovieWriter::MovieWriter(MovieWriter&&) noexcept = default;
MovieWriter& MovieWriter::operator=(MovieWriter&&) noexcept = default;

void MovieWriter::add(const std::vector<std::uint8_t>& rgb) {
  if (rgb.size() != self_->frame_size) self_->fail("a picture does not have the movie's size");
  if (self_->socket < 0) self_->fail("the movie has ended");
  self_->send_all(rgb.data(), rgb.size());
}

void MovieWriter::finish() {
  if (std::exchange(self_->finished, true)) return;
  if (!self_->wait()) self_->fail(self_->complaint(), "check the space on the disk");
  if (std::rename(self_->temporary.c_str(), self_->path.c_str()) != 0)
    self_->fail("cannot rename the temporary file: " + std::generic_category().message(errno));
  forget_unfinished(self_->temporary.c_str());
  self_->temporary.clear();
}

}  // namespace pliant::render
