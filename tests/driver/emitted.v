// The emitted cards with the encoders of their benches, each behind a plug: what the driver's test builds with Verilator. One clock for
// each card: the one that is not looked at stands still.
`timescale 1ns / 1ps

module emitted (
    input wire [1:0] clk, // AXI4-Lite, SPI
    input wire [12:0] awaddr, input wire awvalid, output wire awready,
    input wire [31:0] wdata, input wire wvalid, output wire wready,
    output wire [1:0] bresp, output wire bvalid, input wire bready,
    input wire [12:0] araddr, input wire arvalid, output wire arready,
    output wire [31:0] rdata, output wire [1:0] rresp, output wire rvalid, input wire rready,
    input wire sck, input wire cs_n, input wire mosi, output wire miso,
    // Two channels of each card.
    input wire [3:0] plugged, input wire [3:0] spoil_crc,
    input wire [47:0] position_0, input wire [47:0] position_1,
    output wire [127:0] frames, output wire [127:0] errors
);
    wire [3:0] endat_clk, card_data, card_oe, encoder_data, encoder_oe;
    // Where nobody drives, the termination's bias does: HIGH.
    wire [3:0] line = (card_oe & card_data) | (~card_oe & ((plugged & encoder_oe & encoder_data) | ~(plugged & encoder_oe)));

    axi_lite_card axi_lite_card (
        .clk_i(clk[0]), .rst_i(1'b0), .trigger_i(1'b0), .irq_o(),
        .s_axi_awaddr(awaddr), .s_axi_awvalid(awvalid), .s_axi_awready(awready),
        .s_axi_wdata(wdata), .s_axi_wstrb(4'hF), .s_axi_wvalid(wvalid), .s_axi_wready(wready),
        .s_axi_bresp(bresp), .s_axi_bvalid(bvalid), .s_axi_bready(bready),
        .s_axi_araddr(araddr), .s_axi_arvalid(arvalid), .s_axi_arready(arready),
        .s_axi_rdata(rdata), .s_axi_rresp(rresp), .s_axi_rvalid(rvalid), .s_axi_rready(rready),
        .endat_clk0_o(endat_clk[0]), .endat_data0_o(card_data[0]), .endat_data0_oe(card_oe[0]), .endat_data0_i(line[0]),
        .endat_clk1_o(endat_clk[1]), .endat_data1_o(card_data[1]), .endat_data1_oe(card_oe[1]), .endat_data1_i(line[1]),
        .led_status_o(), .led_channel0_o(), .led_channel1_o()
    );
    spi_card spi_card (
        .clk_i(clk[1]), .rst_i(1'b0), .trigger_i(1'b0), .irq_o(),
        .spi_sck_i(sck), .spi_cs_n_i(cs_n), .spi_mosi_i(mosi), .spi_miso_o(miso), .spi_miso_oe(),
        .endat_clk0_o(endat_clk[2]), .endat_data0_o(card_data[2]), .endat_data0_oe(card_oe[2]), .endat_data0_i(line[2]),
        .endat_clk1_o(endat_clk[3]), .endat_data1_o(card_data[3]), .endat_data1_oe(card_oe[3]), .endat_data1_i(line[3]),
        .led_status_o(), .led_channel0_o(), .led_channel1_o()
    );

    axi_lite_card_tb_encoder #(.CHANNEL(0), .HAS_PARAMETERS(1), .POSITION_BITS(29)) encoder_0 (
        .clk(endat_clk[0] | ~plugged[0]), .driver_oe(card_oe[0]), .driver_data(card_data[0]), .position(position_0),
        .f1(1'b0), .f2(1'b1), .spoil_crc({4'd0, spoil_crc[0]}), .no_start(1'b0), .stay_high(1'b0), .goes_on(1'b0),
        .width(6'd0), .start_ps(32'd0), .may_stop(1'b0),
        .oe(encoder_oe[0]), .data(encoder_data[0]), .crc(), .info_1(), .info_2(),
        .frames(frames[31:0]), .errors(errors[31:0])
    );
    axi_lite_card_tb_encoder #(.CHANNEL(1), .HAS_PARAMETERS(1), .POSITION_BITS(25)) encoder_1 (
        .clk(endat_clk[1] | ~plugged[1]), .driver_oe(card_oe[1]), .driver_data(card_data[1]), .position(position_1),
        .f1(1'b0), .f2(1'b1), .spoil_crc({4'd0, spoil_crc[1]}), .no_start(1'b0), .stay_high(1'b0), .goes_on(1'b0),
        .width(6'd0), .start_ps(32'd0), .may_stop(1'b0),
        .oe(encoder_oe[1]), .data(encoder_data[1]), .crc(), .info_1(), .info_2(),
        .frames(frames[63:32]), .errors(errors[63:32])
    );
    spi_card_tb_encoder #(.CHANNEL(0), .HAS_PARAMETERS(1), .POSITION_BITS(29)) encoder_2 (
        .clk(endat_clk[2] | ~plugged[2]), .driver_oe(card_oe[2]), .driver_data(card_data[2]), .position(position_0),
        .f1(1'b0), .f2(1'b1), .spoil_crc({4'd0, spoil_crc[2]}), .no_start(1'b0), .stay_high(1'b0), .goes_on(1'b0),
        .width(6'd0), .start_ps(32'd0), .may_stop(1'b0),
        .oe(encoder_oe[2]), .data(encoder_data[2]), .crc(), .info_1(), .info_2(),
        .frames(frames[95:64]), .errors(errors[95:64])
    );
    spi_card_tb_encoder #(.CHANNEL(1), .HAS_PARAMETERS(1), .POSITION_BITS(25)) encoder_3 (
        .clk(endat_clk[3] | ~plugged[3]), .driver_oe(card_oe[3]), .driver_data(card_data[3]), .position(position_1),
        .f1(1'b0), .f2(1'b1), .spoil_crc({4'd0, spoil_crc[3]}), .no_start(1'b0), .stay_high(1'b0), .goes_on(1'b0),
        .width(6'd0), .start_ps(32'd0), .may_stop(1'b0),
        .oe(encoder_oe[3]), .data(encoder_data[3]), .crc(), .info_1(), .info_2(),
        .frames(frames[127:96]), .errors(errors[127:96])
    );
endmodule
