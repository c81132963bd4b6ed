"""Files for tests of access: tokens, keys and certificates."""

import os
import subprocess

import pytest

TOKEN, OTHER = "0123456789abcdef", "fedcba9876543210"


class Folder:
    @pytest.fixture(autouse=True)
    def own_folder(self, tmp_path):
        self.folder = str(tmp_path)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w") as file:
            file.write(text)
        os.chmod(self.path(name), 0o600)
        return self.path(name)


def make_certificate(folder):
    """Makes a certificate for this machine. Returns the paths of the certificate and of its key."""
    certificate, key = (os.path.join(folder, name) for name in ("cert.pem", "key.pem"))
    names = ("-subj", "/CN=localhost", "-addext", "subjectAltName=IP:127.0.0.1")
    kind = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2")
    subprocess.run(
        ["openssl", "req", "-x509", *kind, *names, "-keyout", key, "-out", certificate], check=True, capture_output=True
    )
    return certificate, key
