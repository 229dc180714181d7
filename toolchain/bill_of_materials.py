#!/usr/bin/env python3
"""What the installed programs are made of, as SPDX 2.3 (JSON): Debian packages whose shared libraries they load
(DYNAMIC_LINK) or whose headers they were compiled with (STATIC_LINK), each with its version and licence.

    bill_of_materials.py BUILD VERSION OUT PROGRAM...

BUILD is a build folder of Ninja, which knows every header that was read; PROGRAMs are paths in it. Created: as
SOURCE_DATE_EPOCH says, else when the newest program was linked.
"""

import datetime
import json
import os
import pathlib
import re
import subprocess
import sys
import uuid

# Debian's short names that SPDX has under another one; whoever is in neither list becomes a LicenseRef.
RENAMED = {"Expat": "MIT", "BSD-2-clause": "BSD-2-Clause", "BSD-3-clause": "BSD-3-Clause", "zlib": "Zlib",
           "GPL-1+": "GPL-1.0-or-later", "GPL-2": "GPL-2.0-only", "GPL-2+": "GPL-2.0-or-later", "GPL-3": "GPL-3.0-only", "GPL-3+": "GPL-3.0-or-later",
           "LGPL-2+": "LGPL-2.0-or-later", "LGPL-2.1": "LGPL-2.1-only", "LGPL-2.1+": "LGPL-2.1-or-later", "LGPL-3+": "LGPL-3.0-or-later"}
SAME = {"Apache-2.0", "BSL-1.0", "CC0-1.0", "EPL-2.0", "ISC", "MIT", "MPL-2.0", "Zlib", "BSD-2-Clause", "BSD-3-Clause"}


def output(*command, check=True):
    done = subprocess.run([str(part) for part in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                          text=True, check=check, env={**os.environ, "LC_ALL": "C"})
    return done.stdout


def libraries(program):
    """Files of every shared library it loads."""
    return set(re.findall(r"(?:=> |^\s+)(/\S+) \(0x", output("ldd", program), re.MULTILINE))


def headers(build, programs):
    """Headers outside the project that any object of the programs was compiled with."""
    inputs = {line.strip() for line in output("ninja", "-C", build, "-t", "inputs", *programs).splitlines()}
    found, wanted = set(), False
    for line in output("ninja", "-C", build, "-t", "deps").splitlines():
        if line and not line.startswith(" "):
            wanted = line.split(":")[0] in inputs
        elif wanted and line.strip().startswith("/usr/"):
            found.add(line.strip())
    return found


def owners(files):
    """Names of the packages that the files belong to."""
    asked = set()
    for file in files:
        for path in {file, os.path.realpath(file)}:
            asked |= {path, path.removeprefix("/usr") if path.startswith("/usr/lib") else "/usr" + path}
    result = set()
    for line in output("dpkg-query", "--search", *sorted(asked), check=False).splitlines():
        if not line.startswith("diversion "):
            result |= {name.strip() for name in line.rsplit(": ", 1)[0].split(",")}
    return result


def spdx_name(name):
    return RENAMED.get(name) or (name if name in SAME else "LicenseRef-Debian-" + re.sub(r"[^A-Za-z0-9.-]+", "-", name).strip("-"))


def licences(package):
    """The licence names of the package's copyright file; none, when that is not in Debian's machine-readable format."""
    text = pathlib.Path("/usr/share/doc", package, "copyright").read_text(encoding="utf-8", errors="replace")
    if not text.startswith("Format:"):
        return []
    found = set()
    for paragraph in re.split(r"\n\s*\n", text):
        files = re.search(r"^Files:\s*(.*)", paragraph, re.MULTILINE)
        said = re.search(r"^License:[ \t]*(\S.*)", paragraph, re.MULTILINE)
        if files and said and not files[1].startswith("debian/"):
            found |= {spdx_name(name) for name in re.split(r"\s+(?:or|and)\s+|,\s*", said[1].strip()) if name}
    return sorted(found)


def described(name):
    """The package as SPDX has it, and its licences that SPDX does not know."""
    version, architecture = output("dpkg-query", "--show", "--showformat=${Version} ${Architecture}", name).split()
    bare = name.split(":")[0]
    names = licences(bare) or [f"LicenseRef-Debian-copyright-of-{re.sub(r'[^A-Za-z0-9.-]', '-', bare)}"]
    package = {"SPDXID": reference(name), "name": bare, "versionInfo": version, "supplier": "Organization: Debian",
               "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": "NOASSERTION",
               "licenseDeclared": " AND ".join(names), "copyrightText": "NOASSERTION",
               "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                                 "referenceLocator": f"pkg:deb/debian/{bare.replace('+', '%2B')}@{version.replace('+', '%2B')}?arch={architecture}"}]}
    return package, {licence: bare for licence in names if licence.startswith("LicenseRef-")}


def reference(name):
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name.split(":")[0])


def bill(version, linked, compiled, time):
    packages, relationships, texts = [], [], {}
    for name in sorted(linked | compiled):
        package, unknown = described(name)
        packages.append(package)
        for licence, bare in unknown.items():
            texts.setdefault(licence, []).append(bare)
        kinds = [kind for kind, names in (("DYNAMIC_LINK", linked), ("STATIC_LINK", compiled)) if name in names]
        relationships += [{"spdxElementId": "SPDXRef-s4tp", "relationshipType": kind, "relatedSpdxElement": package["SPDXID"]} for kind in kinds]
    packages.insert(0, {"SPDXID": "SPDXRef-s4tp", "name": "s4tp", "versionInfo": version, "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
                        "licenseConcluded": "Apache-2.0", "licenseDeclared": "Apache-2.0", "copyrightText": "NOASSERTION"})
    relationships.insert(0, {"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": "SPDXRef-s4tp"})
    unknown = [{"licenseId": licence, "name": licence, "extractedText": "The text is in " + ", ".join(f"/usr/share/doc/{name}/copyright" for name in names)}
               for licence, names in sorted(texts.items())]
    created = datetime.datetime.fromtimestamp(time, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    document = {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"s4tp-{version}",
                "creationInfo": {"created": created, "creators": ["Tool: bill_of_materials.py"]},
                "packages": packages, "relationships": relationships, "hasExtractedLicensingInfos": unknown}
    document["documentNamespace"] = f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_OID, json.dumps(document, sort_keys=True))}"
    return document


def main(arguments):
    build, version, out, *programs = arguments
    paths = [pathlib.Path(build, program) for program in programs]
    linked = owners(set().union(*map(libraries, paths)))
    compiled = owners(headers(build, programs))
    if not linked or not compiled:
        raise SystemExit("bill of materials: dpkg knows none of the libraries or headers")
    time = int(os.environ.get("SOURCE_DATE_EPOCH") or max(path.stat().st_mtime for path in paths))
    pathlib.Path(out).write_text(json.dumps(bill(version, linked, compiled, time), indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
