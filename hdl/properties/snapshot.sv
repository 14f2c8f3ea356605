// one_set: Position, its width, CRC, F2 and time change together, and only with a good result, or back when that was withdrawn.
// one_number_each: Each result has the next number, and nothing else changes it.
// bad_is_not_fresh: A result without good position leaves the position, and says that it is an earlier one.
// faults_with_results: Cause and flags change only with a result, a fault after it, or when the stored position was found changed.
// restored unless NEVER_WITHDRAWS (positions that are never withdrawn): A position that is withdrawn gives way to the last good one, with its time, or to none if there was none; where that is not kept, no position is valid.
reg f_past_valid; initial f_past_valid = 1'b0;
reg [47:0] f_last; reg [31:0] f_last_stamp; reg f_last_valid;
wire [91:0] f_set = {held, held_width, held_crc, held_f2, stamp};
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    if (take_good) begin
        f_last <= held;
        f_last_stamp <= stamp;
        f_last_valid <= valid;
    end
    if (f_past_valid & !$past(reset)) begin
        one_set: assert ($stable(f_set) | $past(take_good | take_back));
        one_set_strobe: assert (result_strobe == $past(publish));
        one_number_each: assert (count == $past(count) + {15'd0, $past(publish)});
        if ($past(publish & !good & !take_back)) bad_is_not_fresh: assert (!is_fresh & $stable(f_set));
        if (!$past(publish | late_fault | upset_now)) faults_with_results: assert ($stable({cause_held, flags_held}));
        if (!NEVER_WITHDRAWS & $past(take_back & !take_good)) restored: assert (!is_fresh & (KEEPS_EARLIER ? (held == $past(earlier)) & (stamp == $past(earlier_stamp)) & (valid == $past(earlier_valid & !upset_now)) : !valid));
    end
end
// at rest the stored position fits its parity; the proof of a frame begins and ends there
wire f_whole = loaded | (parity_now == parity);
always @* restored_same: assert (!KEEPS_EARLIER | !f_past_valid | !unconfirmed | ((f_last == earlier) & (f_last_stamp == earlier_stamp) & (f_last_valid == earlier_valid)));
