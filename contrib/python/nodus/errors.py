"""What goes wrong, in a message that names the place and what to do."""


class NodusError(Exception):
    """All errors of this package."""


class InputError(NodusError, ValueError):
    """A key, a value or a case that nodus does not take."""


class ResultsError(NodusError, LookupError):
    """Something asked for is not in the results; the message says what there is."""


class RunError(NodusError, RuntimeError):
    """A run that has failed: `code` of its exit, `log`, `folder` of its results, `diagnosis` (text of diagnosis.md, or "")."""

    def __init__(self, message, code, log, folder, diagnosis):
        super().__init__(message)
        self.code, self.log, self.folder, self.diagnosis = code, log, folder, diagnosis
