#include "sim_host/processes/authentic_link.hpp"

#include <stdexcept>

#include "hal/linux/key_file.hpp"
#include "hal/linux/mbedtls_authenticator.hpp"

namespace s4tp::processes {

Keys open_keys(const std::string& place) {
  hal::linux_host::AuthenticationKey key;
  hal::linux_host::Reason reason;
  if (!hal::linux_host::read_key(place.c_str(), key, reason)) throw std::runtime_error(reason.text);
  return std::make_shared<hal::linux_host::MbedtlsAuthenticator>(key);
}

void SessionTeller::tell(std::ostream& out, const secoc::AuthenticCan& can) {
  const secoc::Session& session = can.session();
  if (session.sessions() != sessions_) {
    out << who_ << ": authentic session " << session.sessions() << std::endl;
  } else if (live_ && !session.live()) {
    out << who_ << ": the authentic session is over, nothing has verified for a second" << std::endl;
  }
  sessions_ = session.sessions();
  live_ = session.live();
}

void SessionTeller::sum_up(std::ostream& out, const secoc::AuthenticCan& can) const {
  const secoc::Tally& tally = can.tally();
  out << who_ << ": " << can.session().sessions() << " authentic sessions, " << tally.verified
      << " companions verified, " << tally.refused << " refused\n";
}

}  // namespace s4tp::processes
