// drop FILE…: drops files into the middle of the first window that takes drops (XDND, version 5),
// as a file manager does. Ends with 0 once the window has taken them.
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <poll.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using std::chrono::steady_clock;

constexpr long kVersion = 5;
constexpr std::chrono::seconds kPatience{20};

// RFC 3986: what may stand in a path stands for itself, all else as %XX.
std::string uri_of(const std::string& file) {
  static constexpr char kPlain[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
  std::string uri = "file://";
  for (const char c : std::filesystem::absolute(file).string()) {
    char escaped[4];
    std::snprintf(escaped, sizeof escaped, "%%%02X", static_cast<unsigned char>(c));
    uri += std::strchr(kPlain, c) ? std::string(1, c) : escaped;
  }
  return uri;
}

class Source {
 public:
  Source(Display* display, std::string files) : display_(display), files_(std::move(files)) {
    const Window root = DefaultRootWindow(display_);
    self_ = XCreateSimpleWindow(display_, root, 0, 0, 1, 1, 0, 0, 0);
    target_ = find_target(root);
  }

  bool drop() {
    if (target_ == 0) return fail("no window takes drops");
    XWindowAttributes size;
    XGetWindowAttributes(display_, target_, &size);
    int x = 0, y = 0;
    Window child = 0;
    XTranslateCoordinates(display_, target_, DefaultRootWindow(display_), size.width / 2,
                          size.height / 2, &x, &y, &child);
    XSetSelectionOwner(display_, atom("XdndSelection"), self_, CurrentTime);
    tell("XdndEnter", kVersion << 24, static_cast<long>(atom("text/uri-list")), 0, 0);
    tell("XdndPosition", 0, x << 16 | y, CurrentTime, static_cast<long>(atom("XdndActionCopy")));
    if (!answered("XdndStatus")) return fail("the window does not take these files");
    tell("XdndDrop", 0, CurrentTime, 0, 0);
    if (!answered("XdndFinished")) return fail("the window has not taken the files");
    return true;
  }

 private:
  Atom atom(const char* name) const { return XInternAtom(display_, name, False); }

  static bool fail(const char* why) {
    std::fprintf(stderr, "drop: %s\n", why);
    return false;
  }

  bool takes_drops(Window window) const {
    Atom type = 0;
    int format = 0;
    unsigned long count = 0, rest = 0;
    unsigned char* value = nullptr;
    XGetWindowProperty(display_, window, atom("XdndAware"), 0, 1, False, AnyPropertyType, &type,
                       &format, &count, &rest, &value);
    if (value) XFree(value);
    return type != 0;
  }

  Window find_target(Window window) const {
    if (takes_drops(window)) return window;
    Window root = 0, parent = 0, *children = nullptr, found = 0;
    unsigned count = 0;
    XQueryTree(display_, window, &root, &parent, &children, &count);
    for (unsigned k = 0; k < count && found == 0; ++k) found = find_target(children[k]);
    if (children) XFree(children);
    return found;
  }

  void tell(const char* message, long a, long b, long c, long d) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = target_;
    event.xclient.message_type = atom(message);
    event.xclient.format = 32;
    const long data[] = {static_cast<long>(self_), a, b, c, d};
    std::memcpy(event.xclient.data.l, data, sizeof data);
    XSendEvent(display_, target_, False, NoEventMask, &event);
    XFlush(display_);
  }

  // Hands the files to whoever asks for the selection.
  void serve(const XSelectionRequestEvent& request) {
    const bool known = request.target == atom("text/uri-list");
    if (known)
      XChangeProperty(display_, request.requestor, request.property, request.target, 8,
                      PropModeReplace, reinterpret_cast<const unsigned char*>(files_.data()),
                      static_cast<int>(files_.size()));
    XEvent reply{};
    reply.xselection.type = SelectionNotify;
    reply.xselection.requestor = request.requestor;
    reply.xselection.selection = request.selection;
    reply.xselection.target = request.target;
    reply.xselection.property = known ? request.property : None;
    reply.xselection.time = request.time;
    XSendEvent(display_, request.requestor, False, NoEventMask, &reply);
    XFlush(display_);
  }

  // Waits for the window's message; whether it says yes (some say by bit 0, some by any).
  bool answered(const char* message) {
    const Atom awaited = atom(message);
    const auto end = steady_clock::now() + kPatience;
    while (steady_clock::now() < end) {
      while (XPending(display_) > 0) {
        XEvent event;
        XNextEvent(display_, &event);
        if (event.type == SelectionRequest) serve(event.xselectionrequest);
        if (event.type == ClientMessage && event.xclient.message_type == awaited)
          return event.xclient.data.l[1] != 0;
      }
      pollfd socket{ConnectionNumber(display_), POLLIN, 0};
      ::poll(&socket, 1, 100);
    }
    return false;
  }

  Display* display_;
  std::string files_;
  Window self_ = 0, target_ = 0;
};

}  // namespace

int main(int count, char** words) {
  std::string files;
  for (int k = 1; k < count; ++k) files += uri_of(words[k]) + "\r\n";
  Display* const display = XOpenDisplay(nullptr);
  if (display == nullptr || files.empty()) {
    std::fprintf(stderr, "usage: drop FILE… (with DISPLAY set)\n");
    return 2;
  }
  const bool taken = Source(display, files).drop();
  XCloseDisplay(display);
  return taken ? 0 : 1;
}
